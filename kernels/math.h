// Functions shared by kernels. Only + - * / sqrt, comparisons and integer arithmetic, so that every
// backend gives the same bits (docs/dialect.md).

FN float dot3(float ax, float ay, float az, float bx, float by, float bz) {
    return ax * bx + ay * by + az * bz;
}

// The columns of cells beside ITEMS consecutive queries, and the k-th cells of them all (voxel_normals,
// plane_mean); they name the kernels' own variables. LOAD_COLUMNS sets first, count, most and lowest;
// IN_ROW tells whether the columns begin one cell after the other, as those of neighbours on a flat
// surface do: then whole vectors are loaded where they would be gathered, which takes ten times as long.
#define COLUMNS_AT(index)               \
    EACH_ITEM(i) {                      \
        uint packed = columns[index];   \
        first[i] = packed & 268435455u; \
        count[i] = packed >> 28u;       \
        most = max(most, count[i]);     \
    }
#define LOAD_COLUMNS                                                                            \
    most = 0u;                                                                                  \
    if (m >= uint(ITEMS)) {                                                                     \
        int at = int(plane + base);                                                             \
        COLUMNS_AT(at + i)                                                                      \
    } else {                                                                                    \
        COLUMNS_AT(plane + min(uint(i), m - 1u))                                                \
    }                                                                                           \
    plane = plane + m;                                                                          \
    lowest = n;                                                                                 \
    highest = 0 - n;                                                                            \
    EACH_ITEM(i) {                                                                              \
        int start = int(first[i]) - i;                                                          \
        int none = count[i] > 0u ? 0 : 268435456;                                               \
        lowest = min(lowest, start + none);                                                     \
        highest = max(highest, start - none);                                                   \
    }
#define IN_ROW (ITEMS > 1 && lowest == highest && lowest >= 0 && lowest + int(most) + ITEMS <= n)
