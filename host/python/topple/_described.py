# SPDX-License-Identifier: MIT
"""What help() says of a result and its items: each attribute with its unit. docs/output.md says how they are found."""
from . import _shown, _topple

RESULT = {
    'source': 'str: the path that was parsed; of arrays the name that was given, or "points".',
    'backend': 'str: "native", "opencl" or "vulkan", which it was computed on.',
    'device': 'str: name of that device.',
    'seed': 'int.',
    'voxel_size_m': 'Edge of a solid voxel, metres.',
    'density_kg_m3': 'Of all solids that no correction says other of, kg/m3, as it was given.',
    'friction': 'Coefficient of friction, one for all, as it was given.',
    'offset_m': '(3,), metres: what to add to any coordinate here to have the input\'s own. Zeros but for maps far from their origin.',
    'up': '(3,): unit vector, upwards.',
    'up_method': 'str: "given", or how up was found.',
    'manhattan_from_input': '(4, 4): the rigid transform from the scan\'s frame to the room\'s, z up, walls along x and y.',
    'notes': 'list of str: what the reader of the result should know, a sentence each.',
    'corrections': 'list of AppliedCorrection: what became of those that were given, in their order.',
    'in_blocks': 'bool: a cloud was parsed in blocks (docs/scale.md), and the arrays over its points are of a sample of them.',
    'timings_s': 'dict: seconds by stage, in the order of the stages.',
    'events': 'dict: what was reckoned with, by name: walks, wind_m_s, pga_m_s2 (and pga_spread), tolerable_J, as far as they were asked for.',
    'objects': 'list of Object, by id.',
    'primitives': 'list of Primitive, by id: the parts that objects are made of.',
    'contacts': 'list of Contact: primitives that touch.',
    'supports': 'list of Support: objects that carry others.',
    'point_primitive': '(N,) int32: the primitive of each point that is finite, -1: none.',
    'point_object': '(N,) int32: the object of each point that is finite, -1: none. Where points of the input were left out, point_index '
                    'says which of the input\'s these are.',
    'point_region': '(N,) int32: the smooth piece of surface of each point that is finite, -1: none.',
    'point_index': 'uint64: of arrays, and organised clouds in files, with points that are not finite, the places in them of the N others, ascending; '
                   'empty where all are finite, and of other files.',
    'image_shape': '(height, width) of the depth image that an organised .pcd is, whose pixels are its places, row by row; None: it is none.',
    'solid': 'dict of arrays over the solid voxels: "x", "y", "z", their centres in metres, float32; "primitive", "object", int32; "state", uint8, '
             '0: seen surface, 1: completed.',
    'fields': 'dict by disturbance, of dicts of float32 arrays: "x", "y", "z" in metres; "vx", "vy", "vz", mean direction times strength (m/s; '
              'm/s^2 for earthquakes); "density", visits per event, or exposure in 0 to 1.',
}

_ITEMS = {
    'Object': ('One rigid body: primitives that are fixed to one another. Metres, kilograms, joules, in the scan\'s frame.', {
        'id': 'int: its place in Result.objects.',
        'name': 'str: given by a correction; mostly empty.',
        'corrected': 'list of int: numbers of the corrections about it, from 1.',
        'primitives': 'list of int: ids of its parts.',
        'grounded': 'bool: the ground, that is floor, walls and what is fixed to them. It can\'t fall.',
        'agreement': 'Share of the sampler\'s chains, 0 to 1, that found this object.',
        'mass_kg': 'Kilograms.',
        'mass_error_kg': 'One standard error of the mass, at the density that was given.',
        'mass_model': 'str: "solid", "closed" (furniture of boards) or "hollow" (a shell, as a correction says).',
        'center_of_mass_m': '(3,), metres.',
        'support_height_m': 'How high what it stands on lies along Result.up, metres; NaN: the ground, or nothing was seen that holds it.',
        'center_height_m': 'Of its centre of mass above that, metres; less than 0 for what hangs.',
        'center_of_mass_error_m': '(3,), metres: one standard error of it along each axis.',
        'size_m': '(3,), metres: its box along the room\'s axes, the third upright.',
        'box_middle_m': '(3,): the middle of that box, metres; NaN: nothing of it is solid.',
        'piece_of': 'int: the larger object that it is likelier than not a piece of, which grouping left apart from it; -1: none.',
        'joint_probability': 'How likely the least likely joint at which two parts of it meet is one, 0 to 1; below 0.6 it is about as likely two things.',
        'weakest_joint': 'list of 2 int: the primitives of that joint; -1, -1: it has one part.',
        'piece_probability': 'How likely the likeliest of its joints to larger objects is, 0 to 1; 0: it has none.',
        'inertia_kg_m2': '(3, 3): tensor about its centre of mass.',
        'footprint_error_m': 'One standard error of where the border of its footing lies, metres.',
        'barrier_J': 'Least energy, joules, that moves it out of its place. 0: it falls by itself.',
        'barrier_error_J': 'One standard error of the barrier; one that is not above it can\'t be told from 0.',
        'release_J': 'What it can release then, joules.',
        'landscape': 'Landscape: the poses in which it could lie on level ground, and what keeps them apart.',
        'drop_m': 'Metres that its easiest way leads down beyond its support; 0: it stays on that.',
        'mode': 'str: its easiest way, "tip", "slide" or "none".',
        'direction': '(3,): horizontal unit vector of that way; zeros for "none".',
        'instability': '(steps, 2): W_J and S_J, the energy that it can release once it was given W.',
        'overturning': 'Overturning: the figures of statics.',
        'fragility': 'Fragility: how strong an earthquake upsets it.',
        'barrier_by_direction': 'DirectedBarrier: the barrier by where a push or a blow goes.',
        'risk_J': 'dict by disturbance: expected release per event, joules.',
        'risk_error_J': 'dict: one standard error of that, of all that is not known.',
        'risk_spread_J': 'dict: the part of it that is from the sampling of events.',
        'fall_chance': 'dict: chance per event, 0 to 1, that it falls.',
        'unsafety': '1 (safest) to 10, by its risk among the scene\'s objects; NaN: not seen enough to be ranked, or no disturbance was asked for.',
        'unsafety_category': 'str: "none", "low", "medium" or "high", by itself; None: not seen enough, or no disturbance was asked for.',
        'unsafety_certain': 'bool: whether the category is the same at the better end of one standard error, and the object likelier a whole than a piece of another.',
        'seen_enough': 'bool: whether what holds it up was seen; else its risks are 0 and mean nothing.',
        'rests_by': 'str: how it is held up: "seen" contacts, "near", "leaning", "hidden", "none", or "ground".',
        'rest_probability': 'How probable that is, 0 to 1.',
        'stands_on': 'list of int: the objects that carry it.',
        'why': 'str: why it is as safe as it is, in a sentence.',
        'why_figures': 'Why: the figures of that sentence.',
        'advice': 'str: what would lower its risk, in a sentence; empty: nothing is needed.',
        'action': 'str: what to do about it, so that it agrees with its category: the advice, or that there is no need to act, or to look.',
        'advice_figures': 'Advice: the figures of that sentence.',
        'fall': 'Fall: where it comes to lie.',
    }),
    'Primitive': ('A part: solid, about convex, of which objects are made.', {
        'id': 'int: its place in Result.primitives.',
        'name': 'str: given by a correction to what is of the building; mostly empty.',
        'object': 'int: the object that it is part of.',
        'model': 'str: "plane", "quadric" or "merged".',
        'points': 'int: points of the scan on it.',
        'solid_voxels': 'int.',
        'volume_m3': 'Cubic metres.',
        'mass_kg': 'Kilograms.',
        'center_of_mass_m': '(3,), metres.',
    }),
    'Contact': ('Two primitives that touch.', {
        'a': 'int: id of the one primitive, not of an object.',
        'b': 'int: id of the other primitive.',
        'area_m2': 'Square metres.',
        'normal': '(3,): unit vector from a to b.',
        'relation': 'str: "fixed" (of one object), "support" (one carries the other) or "adjacent".',
        'probability': 'That the joint is fixed, 0 to 1: that both are of one object, whatever `relation` says.',
    }),
    'Support': ('An object that carries another.', {
        'supporter': 'int: id of the object below.',
        'supported': 'int: id of the object that it carries.',
        'area_m2': 'Square metres.',
        'probability': 'That it carries it, 0 to 1.',
    }),
    'Overturning': ('What overturns an object slowly, on its easiest way to tip. NaN where it can\'t tip; errors are one standard error.', {
        'tilt_deg': 'Degrees of lean from which it goes over.',
        'tilt_error_deg': 'Degrees.',
        'direction': '(3,): horizontal unit vector towards there; zeros: any.',
        'push_N': 'Steady level push at its top that tips it, newtons.',
        'push_error_N': 'Newtons.',
        'slide_N': 'Level push that slides it, newtons.',
        'shake_g': 'Level acceleration at which it begins to rock or slide, in g.',
        'hand_push_N': 'As push_N, at the height of a hand.',
        'hand_push_error_N': 'Newtons.',
        'hand_height_m': 'That height, metres.',
        'gust_m_s': 'Gust that is as likely to tip it as not, m/s.',
        'gust_error_m_s': 'm/s.',
    }),
    'Fragility': ('How likely an object is to fall in an earthquake. NaN: few fall at the strongest that is tried.', {
        'pga_g': 'Median peak ground acceleration that upsets it, in g.',
        'pga_dispersion': 'Standard deviation of the logarithm.',
        'firm_pga_g': 'The same median if its foot can\'t slide, in g.',
        'pgv_m_s': 'Median peak ground velocity, m/s.',
        'pgv_dispersion': 'Standard deviation of the logarithm.',
        'counted': '(steps, 2): pga_g, and the share of records and directions in which it fell.',
        'falls_per_year': 'With a hazard curve; NaN without.',
        'return_years': 'Years; NaN without a hazard curve.',
    }),
    'DirectedBarrier': ('What makes an object fall, by direction: n is towards the azimuth n * 22.5 degrees, clockwise from the room\'s y as '
                        'seen from above. inf: no fall was found that way, which is no promise: what stands in its way counts as its end, and '
                        'a drop counts only where a surface was scanned below.', {
                            'height_m': '(heights,): of blows, above what it stands on (Object.support_height_m), metres.',
                            'push_J': '(16,): work of a slow push, joules.',
                            'blow_Ns': '(16, heights): least level blow that makes it fall, as an impulse, newton seconds: what comes at v m/s with '
                                       'm kg and stays brings m v, and up to twice that where it bounces back.',
                            'blow_J': '(16, heights): the energy that this impulse would give to the object if nothing held it, joules; not that of '
                                      'what strikes.',
                            'direction': '(16, 3): horizontal unit vectors in the scan\'s frame, where the push or blow goes; it comes from the '
                                         'opposite side.',
                            'push_N': '(16,): steady level push at Overturning.hand_height_m, newtons, at which it begins to turn over the edge that '
                                      'lies there; inf: none does. Where Overturning.slide_N is less, it slides before. Empty for what hangs.',
                            'push_error_N': '(16,): one standard error of that, newtons.',
                        }),
    'Why': ('Its easiest step out of its pose, of which Object.why tells in words.', {
        'azimuth_deg': 'Degrees from the room\'s y, clockwise as seen from above, of the way that it goes; NaN where none is easier than others.',
        'edge_m': '(2, 3): the ends of the edge that it turns over, or of its support\'s where it slides off, metres; (0, 3): there is none.',
        'W_J': 'Energy that the step takes, joules: Object.barrier_J.',
        'S_J': 'Energy that it can release, joules: Object.release_J.',
        'way_m': 'Metres slid on the support; 0 for other steps.',
        'drop_m': 'Metres fallen beyond where its support ends; 0: it stays on it.',
        'lands_on': 'int: the object below that drop, -1: none.',
        'stands_on': 'list of int: the objects that carry it.',
        'sentence': 'str: Object.why.',
    }),
    'Advice': ('What would lower an object\'s risk to what is tolerated, of which Object.advice tells in words.', {
        'kind': 'str: "" (nothing is needed), "see" (nothing was seen that holds it), "check", "move" or "fix".',
        'move_m': '(3,), metres: for "move" the smallest that does, horizontal, in the scan\'s frame.',
        'risk_J': 'Its largest risk afterwards, joules per event; for "check" its present one.',
        'hold_N': 'For "fix": the horizontal force that a fixing must take, newtons,',
        'hold_height_m': 'at that height above its support, metres.',
        'sentence': 'str: Object.advice.',
        'action': 'str: Object.action.',
    }),
    'Landscape': ('The energy landscape of an object on level ground: its stable poses, by rising energy. Empty where nothing is known.', {
        'now': 'int: the pose in which it was scanned; -1: of the ground.',
        'up': '(poses, 3): unit vectors of the object, as it was scanned, that point up then.',
        'energy_J': '(poses,): potential energy less that as it was scanned, joules.',
        'joins_at_J': '(poses,): the energy at which its basin joins that of a deeper pose; inf for the deepest.',
        'joins': '(poses,) int32: that deeper pose; -1 for the deepest.',
        'probability': '(poses,): of coming to rest in it when tossed.',
    }),
    'Fall': ('Where an object comes to lie, and what that takes along.', {
        'falls': 'bool: whether any disturbance can upset it.',
        'lands_m': '(3,): about its centre of mass at its first landing, metres.',
        'drop_m': 'Metres fallen from its support to there.',
        'lands_on': 'int: the object below that drop, -1: none.',
        'leans_on': 'int: the object that stops it on its way, -1: none.',
        'takes_along': 'list of int: objects that then lose half of their support.',
        'hits_J': 'Energy that it has gathered where it lands, joules.',
        'people_share': 'Share of the walks that pass within reach, 0 to 1; None: nobody was asked for.',
    }),
    'AppliedCorrection': ('What became of a correction.', {
        'do': 'str: as in the correction.',
        'held': 'bool: whether it holds.',
        'outcome': 'str: "held", or what kept it from that.',
        'objects': 'list of int: the objects that it is about.',
    }),
    'Device': ('What a parse computes on (open_device()). It serves one parse at a time.', {
        'backend': 'str: "native", "opencl" or "vulkan".',
        'name': 'str.',
        'gpu': 'bool.',
    }),
}


def items():
    """Puts the words beside the attributes of the library's classes."""
    for kind, (words, attributes) in _ITEMS.items():
        described = getattr(_topple, kind)
        described.__doc__ = words
        for name, text in attributes.items():
            setattr(described, name, property(vars(described)[name].fget, doc=text))


def result(kind):
    """Gives the class Result the attributes of what was parsed."""
    def attribute(name, text):
        return property(lambda self: getattr(self._parsed, name), doc=text)

    def named(name, text):
        return property(lambda self: _shown.with_names(getattr(self._parsed, name), self.objects), doc=text)
    for name, text in RESULT.items():
        setattr(kind, name, (named if name in ('supports', 'corrections') else attribute)(name, text))
    return kind
