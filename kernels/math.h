// Functions shared by kernels. Only + - * / sqrt, comparisons and integer arithmetic, so that every
// backend gives the same bits (docs/dialect.md).

FN float dot3(float ax, float ay, float az, float bx, float by, float bz) {
    return ax * bx + ay * by + az * bz;
}
