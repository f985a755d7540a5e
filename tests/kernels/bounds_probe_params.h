// Parameters of bounds_probe.
STRUCT(BoundsProbeParams) {
    uint read;    // added to the index of what a work-item reads
    int written;  // of what it writes
    uint added;   // of what it adds to
    uint whole;   // of what its group reads
} STRUCT_END(BoundsProbeParams)
