// Parameters of the probes, which measure what a backend can do at most.

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

// divide
STRUCT(DivideParams) {
    uint count;   // elements, a multiple of the items per work-item
    uint rounds;  // divisions per element
} STRUCT_END(DivideParams)

// gather
STRUCT(GatherParams) {
    uint count;   // elements, a multiple of the items per work-item
    uint rounds;  // words per element
    uint shift;   // of a state to a place in the table, 1 to 31
} STRUCT_END(GatherParams)
