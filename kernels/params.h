// Parameters of every kernel, shared by kernels and host. 4-byte scalars only, 128 bytes at most;
// the generated headers assert the offsets. Each struct stands under the name of its kernel.

// triad
STRUCT(TriadParams) {
    uint count;   // elements
    float scale;
} STRUCT_END(TriadParams)

// multiply_add
STRUCT(MultiplyAddParams) {
    uint count;   // elements, a multiple of the items per work-item
    uint rounds;  // multiply-adds per element
} STRUCT_END(MultiplyAddParams)

// support_function
STRUCT(SupportParams) {
    uint vertex_count;     // of this primitive
    uint vertex_first;     // where they start in the vertex arrays
    uint direction_count;
    uint output_first;     // where this primitive's row starts in the output
} STRUCT_END(SupportParams)
