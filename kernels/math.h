// Functions shared by kernels. Only + - * / sqrt, comparisons and integer arithmetic, so that every
// backend gives the same bits (docs/dialect.md).

FN float dot3(float ax, float ay, float az, float bx, float by, float bz) {
    return ax * bx + ay * by + az * bz;
}

// The columns of cells beside ITEMS consecutive queries (voxel_normals, plane_mean); they name the kernels'
// own variables. LOAD_COLUMNS sets first, count, most, and near: whether all their cells lie near lowest, as
// those of neighbours in a sorted list mostly do. PLACE_CELLS sets the places of the k-th cells, from lowest
// or, where they are far from one another, from the first cell of all; a query whose column has ended takes
// one that counts for nothing.
#define COLUMNS_AT(index)               \
    EACH_ITEM(i) {                      \
        uint packed = columns[index];   \
        first[i] = packed & 268435455u; \
        count[i] = packed >> 28u;       \
        most = max(most, count[i]);     \
    }
#define LOAD_COLUMNS                                                       \
    most = 0u;                                                             \
    if (m >= uint(ITEMS)) {                                                \
        int at = int(plane + base);                                        \
        COLUMNS_AT(at + i)                                                 \
    } else {                                                               \
        COLUMNS_AT(plane + min(uint(i), m - 1u))                           \
    }                                                                      \
    plane = plane + m;                                                     \
    lowest = 268435456;                                                    \
    highest = 0;                                                           \
    EACH_ITEM(i) {                                                         \
        lowest = min(lowest, int(first[i]) + (count[i] > 0u ? 0 : 268435456)); \
        highest = max(highest, int(first[i] + count[i]));                  \
    }                                                                      \
    near = NEAR_WORDS > 0 && highest - lowest <= NEAR_WORDS && lowest + NEAR_WORDS <= n;
#define PLACE_CELLS                                                        \
    EACH_ITEM(i) {                                                         \
        int j = int(k < count[i] ? first[i] + k : me[i]);                  \
        place[i] = near ? (k < count[i] ? j - lowest : 0) : j;             \
    }
#define LOAD_FAR(to, from, base, place) EACH_ITEM(i) { to[i] = from[(base) + place[i]]; }

// What a ray of the six-direction filling that goes a way meets at a cell (six_fill_sweep): its label,
// and at bit 16 whether it meets the side that was seen.
FN uint six_fill_met(uint cell, uint direction) {
    return (cell & 65535u) | ((cell >> (16u + direction) & 1u) << 16u);
}
