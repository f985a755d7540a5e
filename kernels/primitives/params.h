// Parameters of the primitives: what kernels of other kinds are made of.

// chunk_sums, chunk_scan, scan_base, reduce_uint, reduce_float
STRUCT(ChunkParams) {
    uint count;  // elements
    uint mode;   // what each of the kernels says
} STRUCT_END(ChunkParams)

// chunk_compact
STRUCT(CompactParams) {
    uint count;         // elements
    uint window_first;  // place among all that are kept that dst starts with
    uint window_count;  // words of dst
} STRUCT_END(CompactParams)

// gather_words, scatter_words, add_by_key
STRUCT(IndexedParams) {
    uint count;         // indices
    uint window_first;  // index that the indexed array starts with
    uint window_count;  // words of it
    uint mode;          // what each of the kernels says
} STRUCT_END(IndexedParams)

// radix_count, radix_scatter
STRUCT(RadixParams) {
    uint count;         // keys of the tile
    uint chunk;         // keys of a chunk
    uint chunks;        // of all tiles
    uint chunk_first;   // of the tile, among them
    uint shift;         // of a key to the digit
    uint payloads;      // arrays that go along, 0 to 2
    uint window_first;  // place among all keys that the output starts with
    uint window_count;  // words of it
} STRUCT_END(RadixParams)

// run_counts, run_starts, run_open, run_sums, run_tails, run_scan
STRUCT(RunParams) {
    uint count;         // elements of the tile
    uint skip;          // words of the slices that lie before the tile's first: none at the first tile
    uint tile_first;    // index of that among all
    uint kind;          // RUN_OF_... of functions.h
    uint window_first;  // run that the output starts with
    uint window_count;  // words of it
    uint mode;          // what each of the kernels says
} STRUCT_END(RunParams)

// run_lengths
STRUCT(RunLengthsParams) {
    uint first;  // run
    uint most;   // words of length
} STRUCT_END(RunLengthsParams)

// component_init, component_link, component_flatten
STRUCT(ComponentParams) {
    uint nodes;
    uint edges;  // of this tile
} STRUCT_END(ComponentParams)

// grid_keys
STRUCT(GridKeysParams) {
    uint count;   // points
    float per_m;  // 1 / edge of a cell
} STRUCT_END(GridKeysParams)

// grid_shift
STRUCT(GridShiftParams) {
    uint count;  // keys
    int di;      // cells
    int dj;
    int dk;
    uint keep;   // bits of the low word that stay
} STRUCT_END(GridShiftParams)

// grid_bounds
STRUCT(GridBoundsParams) {
    uint count;   // keys
    uint stride;  // words from one array of bounds to the next
} STRUCT_END(GridBoundsParams)

// grid_pack, grid_unpack
STRUCT(GridPackParams) {
    uint count;   // keys
    uint x;       // least leaf, plus 2^17
    uint y;
    uint z;
    uint bits_y;  // of a leaf's y less the least
    uint bits_z;
    uint none;    // what stands for no cell
} STRUCT_END(GridPackParams)

// grid_masks
STRUCT(GridMasksParams) {
    uint leaves;
} STRUCT_END(GridMasksParams)

// grid_find
STRUCT(GridFindParams) {
    uint count;   // cells that are looked for
    uint leaves;  // of the grid
} STRUCT_END(GridFindParams)

// search_keys
STRUCT(SearchKeysParams) {
    uint count;  // keys that are looked for
    uint keys;   // that there are
} STRUCT_END(SearchKeysParams)
