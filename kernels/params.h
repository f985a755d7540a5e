// Parameters of every kernel, shared by kernels and host. 4-byte scalars only, 128 bytes at most;
// the generated headers assert the offsets. Each struct stands under the name of its kernel.

// support_function
STRUCT(SupportParams) {
    uint vertex_count;     // of this primitive
    uint vertex_first;     // where they start in the vertex arrays
    uint direction_count;
    uint output_first;     // where this primitive's row starts in the output
} STRUCT_END(SupportParams)

// voxel_normals
STRUCT(VoxelNormalsParams) {
    uint query_count;
    uint cell_count;      // stride of the planes of cells and prior
    int radius;           // of the neighbourhood, cells per axis, 1 to 3
    float inverse_reach2; // 1 / (distance at which a cell's weight falls to 0)^2, cells^-2
    uint use_prior;       // 1: weigh cells by agreement of normals
} STRUCT_END(VoxelNormalsParams)

// plane_mean
STRUCT(PlaneMeanParams) {
    uint query_count;
    uint cell_count;    // stride of the planes
    int radius;         // of the neighbourhood, cells per axis, 1 to 3
    float reach2;       // (distance at which a cell's weight falls to 0)^2, cells^2
    float least_cosine; // of the angle between two normals of one surface
} STRUCT_END(PlaneMeanParams)

// normal_cluster
STRUCT(NormalClusterParams) {
    uint count;         // normals
    uint cluster_count; // 1 to 32
} STRUCT_END(NormalClusterParams)

// disturbance_reach
STRUCT(DisturbanceReachParams) {
    uint cell_count;  // cells in the tile, a multiple of 64
    uint row_count;   // offsets, one output row each
} STRUCT_END(DisturbanceReachParams)

// disturbance
STRUCT(DisturbanceParams) {
    uint cell_count;       // cells in the tile, a multiple of 64
    uint row_count;        // rows of `blocked` per block
    uint plane_cells;      // stride of the planes of `primary`
    uint direction_count;
    uint footprint_first;  // of this part: index into entry_first of its direction 0
    uint band_first;       // height band of the first output plane, 0 to 31
    uint band_count;       // output planes per direction
    uint output_first;     // where the part's planes start in the output
} STRUCT_END(DisturbanceParams)

// carve_leaves, carve
STRUCT(CarveParams) {
    uint leaf_count;
    uint frame_count;       // of this batch, 32 at most
    uint width;             // words in a row of a frame's finest level: pixels - 1
    uint height;            // rows of it: pixels - 1
    uint frame_words;       // all levels of one frame
    float near_m;           // nothing closer to the camera plane is judged
    float metres_per_unit;  // of stored depth
    float margin_m;         // half a voxel's diagonal, and half a depth unit
    float noise_base_m;     // depth noise: base + growth * max(depth - from, 0)^2
    float noise_growth;     // 1/m
    float noise_from_m;
    float slack_m;          // of carve_leaves alone, for rounding
} STRUCT_END(CarveParams)

// six_fill_sweep
STRUCT(SixFillSweepParams) {
    uint run_count;
    uint direction;  // backward along the axis: 0, 2 or 4; the next one is forward
} STRUCT_END(SixFillSweepParams)

// six_fill_vote
STRUCT(SixFillVoteParams) {
    uint count;  // voxels, of whole leaves
    uint votes;  // directions that must agree
    uint columns;  // 1: what lies hidden under a top, down to where it stands, is filled, too
} STRUCT_END(SixFillVoteParams)

// segmented_sum
STRUCT(SegmentedSumParams) {
    int origin_i;  // lowest indices of the scene: sums are taken relative to them
    int origin_j;
    int origin_k;
} STRUCT_END(SegmentedSumParams)

// cell_share
STRUCT(CellShareParams) {
    uint cell_count;
    float voxel_m;
} STRUCT_END(CellShareParams)

// dense_layer
STRUCT(DenseLayerParams) {
    uint rows;
    uint outputs;       // a multiple of 32
    uint width_a;
    uint width_b;
    uint width_c;
    uint weight_first;  // where the layer starts in the weights
    uint rectified;     // 1: outputs below 0 are 0
    uint added;         // 1: to what the outputs hold
} STRUCT_END(DenseLayerParams)

// neighbour_pool
STRUCT(NeighbourPoolParams) {
    uint nodes;
    uint width;  // a multiple of 32
} STRUCT_END(NeighbourPoolParams)

// group_stance
STRUCT(GroupStanceParams) {
    uint groups;
    uint directions;  // a multiple of 16
} STRUCT_END(GroupStanceParams)

// rocking
STRUCT(RockingParams) {
    uint event_count;  // a multiple of 64
    uint body_count;
    uint chunk_count;  // of all records
    float gravity;     // m/s^2
    float longest_s;   // after a record's end, until a motion has to have come to its own
    uint chunk_first;  // of each motion, the chunks of steps that are followed: begun where it is 0,
    uint chunk_last;   // before this one
} STRUCT_END(RockingParams)

// dialect_probe
STRUCT(DialectProbeParams) {
    uint count;  // elements
} STRUCT_END(DialectProbeParams)

// barrier_probe
STRUCT(BarrierProbeParams) {
    uint count;  // elements
} STRUCT_END(BarrierProbeParams)
