#if defined(__x86_64__)
#define ORBWEAVER_VECTOR_BYTES 64
#define ORBWEAVER_BLOCK_KERNEL run_in_512_bits
#include "block_kernels.inl"
#endif
