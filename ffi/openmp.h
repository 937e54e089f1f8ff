/*
 * The functions of the OpenMP runtime that brinell calls, for bindgen (OpenMP 3.0, section 3.2).
 *
 * Declared here and not taken from the compiler's own omp.h, which a compiler other than libclang's keeps where libclang does not look.
 */
#ifndef BRINELL_OPENMP_H
#define BRINELL_OPENMP_H

/* Depth to which parallel regions may be active in the calling thread; 0: none is. */
int omp_get_max_active_levels(void);
void omp_set_max_active_levels(int levels);

#endif
