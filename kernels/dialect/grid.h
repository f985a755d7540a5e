// Sparse grids in kernels of all backends: what stands before a kernel that uses words of GRID_.

// Keys of a sparse grid's cells: their coordinates plus 2^20, 21 bits each, those of the leaf of 8 x 8 x 8 cells above
// those of the cell in it, x above y above z. So a leaf's cells are neighbours in order, and the key of its first one,
// whose lowest 9 bits are 0, is the leaf's. GRID_NONE twice: of no cell.
#define GRID_NONE 0xffffffffu
#define GRID_BIAS 1048576
#define GRID_LEAF_LOW(y, z) (((y) << 27) | ((z) << 9))
#define GRID_LEAF_HIGH(x, y) (((x) << 13) | ((y) >> 5))
#define GRID_LOW(i, j, k) (GRID_LEAF_LOW((j) >> 3, (k) >> 3) | (((i) & 7u) << 6) | (((j) & 7u) << 3) | ((k) & 7u))
#define GRID_HIGH(i, j) GRID_LEAF_HIGH((i) >> 3, (j) >> 3)
// Of a key's words the leaf's coordinates plus 2^17.
#define GRID_LEAF_X(high) ((high) >> 13)
#define GRID_LEAF_Y(low, high) ((((high) & 0x1fffu) << 5) | ((low) >> 27))
#define GRID_LEAF_Z(low) (((low) >> 9) & 0x3ffffu)

// A statement that declares `at`: the cell (i, j, k) of `grid`, a GRID_IN of so many leaves, by its place in the order
// of the grid's cells, or GRID_NONE where the grid has no such cell. The leaf by binary search, the cell by the bits
// below its own.
#define GRID_FIND(at, grid, leaves, i, j, k)                                                            \
    uint at = GRID_NONE;                                                                                \
    {                                                                                                   \
        uint x_ = uint(i) + uint(GRID_BIAS);                                                            \
        uint y_ = uint(j) + uint(GRID_BIAS);                                                            \
        uint z_ = uint(k) + uint(GRID_BIAS);                                                            \
        uint bit_ = GRID_LOW(x_, y_, z_) & 511u;                                                        \
        uint low_ = GRID_LOW(x_, y_, z_) - bit_;                                                        \
        uint high_ = GRID_HIGH(x_, y_);                                                                 \
        uint leaf_ = 0u;                                                                                \
        for (uint left_ = ((x_ | y_ | z_) >> 21) == 0u ? uint(leaves) : 0u; left_ > 0u;) {              \
            uint half_ = left_ >> 1;                                                                    \
            uint above_ = grid##_leaf_high[leaf_ + half_];                                              \
            bool before_ = above_ < high_ || (above_ == high_ && grid##_leaf_low[leaf_ + half_] < low_); \
            leaf_ = before_ ? leaf_ + half_ + 1u : leaf_;                                               \
            left_ = before_ ? left_ - half_ - 1u : half_;                                               \
        }                                                                                               \
        if (((x_ | y_ | z_) >> 21) == 0u && leaf_ < uint(leaves)) {                                     \
            uint mask_ = grid##_mask[16u * leaf_ + (bit_ >> 5)];                                        \
            uint one_ = 1u << (bit_ & 31u);                                                             \
            if (grid##_leaf_low[leaf_] == low_ && grid##_leaf_high[leaf_] == high_ && (mask_ & one_) != 0u) { \
                at = grid##_first[leaf_] + bit_count(mask_ & (one_ - 1u));                              \
                for (uint w_ = 0u; w_ < (bit_ >> 5); w_++) { at += bit_count(grid##_mask[16u * leaf_ + w_]); } \
            }                                                                                           \
        }                                                                                               \
    }
