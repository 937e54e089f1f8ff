/*
 * The configuration functions of OpenBLAS that brinell calls, for bindgen.
 *
 * Declared here and not taken from OpenBLAS' own cblas.h, whose place differs from one
 * distribution to the next. They are the same in every release since 0.2.19.
 */
#ifndef BRINELL_OPENBLAS_H
#define BRINELL_OPENBLAS_H

/* Version and build options, a static string; never freed. */
char *openblas_get_config(void);
/* Name of the processor kernels in use, a static string; never freed. */
char *openblas_get_corename(void);
/* Threads that the next call may use, for the whole process. */
int openblas_get_num_threads(void);
void openblas_set_num_threads(int num_threads);

/*
 * Cholesky factor of LAPACK, called for a matrix of one entry: it makes OpenBLAS take its work buffer. The
 * integers are wide enough for either build of the library.
 */
void dpotrf_(const char *uplo, const long long *n, double *a, const long long *lda, long long *info);

#endif
