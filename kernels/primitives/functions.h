// What the primitives share.

// Runs of equal keys in a sorted list, or segments that a flag other than 0 opens (kernels/primitives/run_*);
// they name the kernels' own variables. RUN_BEFORE(at) tells what lies before place `at` of the slice, RUN_NEXT(at)
// declares `opens`: whether a run begins at `at`. Behind place 0 a slice holds the word before the tile's first; place
// 0 itself begins a run, but for chunks' flags.
#define RUN_OF_FLAGS 0u
#define RUN_OF_CHUNK_FLAGS 1u
#define RUN_OF_KEYS 2u
#define RUN_OF_WIDE_KEYS 3u
#define RUN_BEFORE(at)                                                       \
    uint low_before = 0u;                                                    \
    uint high_before = 0u;                                                   \
    if ((at) == 0u && p.kind != RUN_OF_CHUNK_FLAGS) {                        \
        low_before = ~low[0];                                                \
    } else if (p.kind >= RUN_OF_KEYS) {                                      \
        low_before = low[(at) - 1u];                                         \
        if (p.kind == RUN_OF_WIDE_KEYS) { high_before = high[(at) - 1u]; }   \
    }
#define RUN_NEXT(at)                                                         \
    uint low_word = low[at];                                                 \
    uint high_word = p.kind == RUN_OF_WIDE_KEYS ? high[at] : 0u;             \
    bool opens = low_word != low_before || high_word != high_before;         \
    low_before = p.kind < RUN_OF_KEYS ? 0u : low_word;                       \
    high_before = high_word;

// 1,024 elements of src from `begin` to one (kernels/primitives/reduce_*), as far as there are `count` of them: element
// i goes to strand i % 16, strands are joined in a tree. So the order is one on all devices, which floats need.
#define REDUCE_WORDS 1024u
#define REDUCE_STRANDS(T, start, step)                                                               \
    T strand[ITEMS];                                                                                 \
    EACH_ITEM(k) { strand[k] = start; }                                                              \
    uint end = begin + min(p.count - begin, REDUCE_WORDS);                                           \
    uint i = begin;                                                                                  \
    for (; i + 16u <= end; i += 16u) {                                                               \
        int at = int(i);                                                                             \
        EACH_ITEM(k) { T a = strand[k]; T b = src[at + k]; strand[k] = step; }                       \
    }                                                                                                \
    for (int k = 0; i < end; i++) { T a = strand[k]; T b = src[i]; strand[k] = step; k++; }          \
    for (int half_of = ITEMS / 2; half_of > 0; half_of = half_of / 2) {                              \
        for (int k = 0; k < half_of; k++) { T a = strand[k]; T b = strand[k + half_of]; strand[k] = step; } \
    }                                                                                                \
    dst[GLOBAL_ID] = strand[0];
