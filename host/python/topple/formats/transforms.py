# SPDX-License-Identifier: MIT
"""The tree of frames that ROS' /tf and /tf_static describe, over time."""
import bisect

import numpy as np

from .frames import rotation

# Transforms come tens of times a second; farther from the next one a pose would be a guess.
FARTHEST_NS = 500_000_000


def _between(first, second, share):
    """The unit quaternion at a share of the way along the shorter arc."""
    cosine = float(np.dot(first, second))
    if cosine < 0:
        second, cosine = -second, -cosine
    if cosine > 0.9995:
        out = first + share * (second - first)
        return out / np.linalg.norm(out)
    angle = np.arccos(cosine)
    return (np.sin((1 - share) * angle) * first + np.sin(share * angle) * second) / np.sin(angle)


class _Edge:
    """Where a frame lies in its parent, by time."""

    def __init__(self, parent):
        self.parent, self.fixed = parent, None
        self.times, self.values = [], []

    def add(self, time, quaternion, position):
        self.times.append(time)
        self.values.append((np.array(quaternion, float), np.array(position, float)))

    def sort(self):
        order = sorted(range(len(self.times)), key=self.times.__getitem__)
        self.times = [self.times[n] for n in order]
        self.values = [self.values[n] for n in order]
        # Of what does not move, few messages tell all, however far from them in time.
        if self.values and not self.fixed:
            turns, places = (np.array(column) for column in zip(*self.values))
            if np.allclose(np.abs(turns @ turns[0]), 1, atol=1e-12) and np.allclose(places, places[0], rtol=0, atol=1e-9):
                self.fixed = self.values[0]

    def at(self, time):
        """4 x 4, child to parent; None where no transform is near enough in time."""
        if self.fixed:
            quaternion, position = self.fixed
        else:
            after = bisect.bisect_left(self.times, time)
            if after < len(self.times) and self.times[after] == time:
                quaternion, position = self.values[after]
            elif 0 < after < len(self.times):
                before, share = after - 1, (time - self.times[after - 1]) / (self.times[after] - self.times[after - 1])
                if self.times[after] - self.times[before] > 2 * FARTHEST_NS:
                    return None
                (q, p), (r, s) = self.values[before], self.values[after]
                quaternion, position = _between(q, r, share), p + share * (s - p)
            else:
                nearest = min(after, len(self.times) - 1)
                if abs(self.times[nearest] - time) > FARTHEST_NS:
                    return None
                quaternion, position = self.values[nearest]
        out = np.eye(4)
        out[:3, :3] = rotation(*quaternion)
        out[:3, 3] = position
        return out


class Transforms:
    def __init__(self):
        self.edges = {}

    def add(self, message, fixed):
        """A TFMessage of /tf_static (fixed) or /tf."""
        for stamped in message.transforms:
            child, parent = stamped.child_frame_id.lstrip('/'), stamped.header.frame_id.lstrip('/')
            q, p = stamped.transform.rotation, stamped.transform.translation
            quaternion = np.array([q.x, q.y, q.z, q.w], float)
            norm = np.linalg.norm(quaternion)
            if not (np.isfinite(norm) and norm > 1e-6) or child == parent:
                continue
            edge = self.edges.get(child)
            if edge is None or edge.parent != parent:
                edge = self.edges[child] = _Edge(parent)
            if fixed:
                edge.fixed = quaternion / norm, np.array([p.x, p.y, p.z], float)
            else:
                stamp = stamped.header.stamp
                edge.add(stamp.sec * 1_000_000_000 + stamp.nanosec, quaternion / norm, [p.x, p.y, p.z])

    def sort(self):
        for edge in self.edges.values():
            edge.sort()

    def root_of(self, frame):
        """The frame that nothing is above of; of a loop the frame itself."""
        seen = {frame}
        at = frame
        while at in self.edges:
            at = self.edges[at].parent
            if at in seen:
                return frame
            seen.add(at)
        return at

    def to_root(self, frame, time):
        """4 x 4 from a frame to its root at a time in ns; None where it is not known."""
        out, seen = np.eye(4), set()
        while frame in self.edges and frame not in seen:
            seen.add(frame)
            step = self.edges[frame].at(time)
            if step is None:
                return None
            out, frame = step @ out, self.edges[frame].parent
        return out
