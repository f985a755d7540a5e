// SPDX-License-Identifier: MIT
#pragma once

namespace topple::pose_mends {

// What makes camera-to-world poses with x right, y down and z ahead of those in another convention:
// in words, and in NumPy's, for who has them as arrays.
struct PoseMend {
    const char *words, *numpy;
};

inline constexpr PoseMend inverse{"the inverse of each pose", "np.linalg.inv(pose)"};
inline constexpr PoseMend turned{"each pose with its second and third columns negated",
                                 "pose @ np.diag([1, -1, -1, 1])"};
inline constexpr PoseMend inverse_turned{
    "the inverse of each pose, with its second and third columns negated",
    "np.linalg.inv(pose) @ np.diag([1, -1, -1, 1])"};
inline constexpr PoseMend reordered{
    "each pose with its columns in this order: the second negated, the third negated, the first, "
    "the fourth",
    "pose @ [[0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]]"};
inline constexpr PoseMend inverse_reordered{
    "the inverse of each pose, with its columns in this order: the second negated, the third "
    "negated, the first, the fourth",
    "np.linalg.inv(pose) @ [[0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]]"};
inline constexpr PoseMend w_last{"poses of their quaternions as x, y, z, w", "q[[1, 2, 3, 0]]"};
inline constexpr PoseMend transposed{
    "each pose with its 3 x 3 rotation transposed, as matrices are row-major",
    "pose[:3, :3] = pose[:3, :3].T"};
inline constexpr PoseMend all[] = {inverse,           turned, inverse_turned, reordered,
                                   inverse_reordered, w_last, transposed};

}  // namespace topple::pose_mends
