// Parameters of my_app's kernels.
STRUCT(SmoothParams) {
    uint count;  // heights, 1 or more
} STRUCT_END(SmoothParams)
