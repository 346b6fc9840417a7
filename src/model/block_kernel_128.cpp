#define ORBWEAVER_VECTOR_BYTES 16
#define ORBWEAVER_BLOCK_KERNEL run_in_128_bits
#include "block_kernels.inl"
