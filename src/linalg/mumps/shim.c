/* Messages of MPI, and MUMPS behind a few numbers: its structure changes from version to version
 * and is known here alone. What all ranks do together (create, analyse, factor, solve, free) all
 * of them call, in the same order; arrays that concern the first rank alone may be NULL on the
 * others. */
#include <dmumps_c.h>
#include <mpi.h>
#include <stdint.h>
#include <stdlib.h>
#include <time.h>

static const int TAG = 4711;
static const int USE_COMM_WORLD = -987654;
/* ICNTL(14): workspace beyond what is estimated, in per cent; and where that was too little. */
static const int WORKSPACE = 40;
static const int MORE_WORKSPACE = 200;
/* Bytes of a message: counts of MPI are ints. */
static const int64_t LONGEST = 1 << 30;
static DMUMPS_STRUC_C **all;
static int n_all;
static int is_ours;

/* Joins the other ranks, or is alone. */
int brinell_mpi_begin(int *rank, int *size) {
    int begun = 0, provided = 0;
    if (MPI_Initialized(&begun) != MPI_SUCCESS) return 0;
    if (!begun) {
        if (MPI_Init_thread(NULL, NULL, MPI_THREAD_SERIALIZED, &provided) != MPI_SUCCESS) return 0;
        if (provided < MPI_THREAD_SERIALIZED) return 0;
        is_ours = 1;
    }
    MPI_Comm_rank(MPI_COMM_WORLD, rank);
    MPI_Comm_size(MPI_COMM_WORLD, size);
    return 1;
}

void brinell_mpi_end(void) {
    int ended = 0;
    MPI_Finalized(&ended);
    if (!ended && is_ours) MPI_Finalize();
}

/* A length, then so many bytes. */
void brinell_mpi_send(int to, const char *bytes, int64_t length) {
    MPI_Send(&length, 1, MPI_INT64_T, to, TAG, MPI_COMM_WORLD);
    for (int64_t sent = 0; sent < length; sent += LONGEST) {
        int64_t left = length - sent;
        int part = (int)(left < LONGEST ? left : LONGEST);
        MPI_Send(bytes + sent, part, MPI_CHAR, to, TAG, MPI_COMM_WORLD);
    }
}

/* The length of the next message. Waiting leaves the processor to others. */
int64_t brinell_mpi_await(int from) {
    const struct timespec pause = {0, 200000};
    int there = 0;
    int64_t length = 0;
    for (;;) {
        MPI_Iprobe(from, TAG, MPI_COMM_WORLD, &there, MPI_STATUS_IGNORE);
        if (there) break;
        nanosleep(&pause, NULL);
    }
    MPI_Recv(&length, 1, MPI_INT64_T, from, TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return length;
}

/* Its bytes. */
void brinell_mpi_receive(int from, char *bytes, int64_t length) {
    for (int64_t got = 0; got < length; got += LONGEST) {
        int64_t left = length - got;
        int part = (int)(left < LONGEST ? left : LONGEST);
        MPI_Recv(bytes + got, part, MPI_CHAR, from, TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    }
}

/* A solver without a matrix, by the number that it is to have. A rank without memory for it ends
 * all: the others are in the same call. */
static void create(int index) {
    DMUMPS_STRUC_C *id;
    if (index >= n_all) {
        DMUMPS_STRUC_C **more = realloc(all, (index + 1) * sizeof *all);
        if (!more) MPI_Abort(MPI_COMM_WORLD, 5);
        all = more;
        for (; n_all <= index; ++n_all) all[n_all] = NULL;
    }
    id = all[index] = calloc(1, sizeof *id);
    if (!id) MPI_Abort(MPI_COMM_WORLD, 5);
    id->par = 1;
    id->sym = 1;
    id->comm_fortran = USE_COMM_WORLD;
    id->job = -1;
    dmumps_c(id);
    for (int unit = 0; unit < 4; ++unit) id->icntl[unit] = 0;
}

/* Analyses, with a new solver of this number, the order of elimination of a symmetric positive
 * definite matrix of `n` variables. Each rank hands over entries of one triangle, numbered from
 * 1. First rank: the `place` of each variable, and in `schur_list`, as they come, the last
 * `n_schur` variables, which are not eliminated. `info` gets INFOG(1), INFOG(2), INFOG(7),
 * INFO(15) and INFO(1), `work` RINFOG(1) and INFOG(20). The arrays stay in use until the matrix
 * is factored. */
void brinell_mumps_analyse(int index, int n, int64_t n_entries, int *rows, int *columns, int *place,
                           int n_schur, int *schur_list, int info[5], double work[2]) {
    DMUMPS_STRUC_C *id;
    create(index);
    id = all[index];
    id->n = n;
    id->nnz_loc = n_entries;
    id->irn_loc = rows;
    id->jcn_loc = columns;
    id->perm_in = place;
    id->icntl[17] = 3;  /* ICNTL(18): each rank has its own entries */
    id->icntl[6] = 1;   /* ICNTL(7): the order is given */
    id->icntl[27] = 1;  /* ICNTL(28): sequential analysis */
    id->icntl[13] = WORKSPACE;
    if (n_schur > 0) {
        id->icntl[18] = 1; /* ICNTL(19): the Schur complement on the first rank */
        id->size_schur = n_schur;
        id->listvar_schur = schur_list;
    }
    id->job = 1;
    dmumps_c(id);
    info[0] = id->infog[0];
    info[1] = id->infog[1];
    info[2] = id->infog[6];
    info[3] = id->info[14];
    info[4] = id->info[0];
    work[0] = id->rinfog[0];
    work[1] = id->infog[19] < 0 ? -1e6 * id->infog[19] : id->infog[19];
}

/* Factors; `schur` gets the matrix of the variables that stay by rows, its lower triangle. `info`
 * gets INFOG(1), INFOG(2), INFOG(12), the number of negative pivots, and INFO(1). */
void brinell_mumps_factor(int index, double *values, double *schur, int info[4]) {
    DMUMPS_STRUC_C *id = all[index];
    int code;
    id->a_loc = values;
    id->schur = schur;
    id->job = 2;
    dmumps_c(id);
    code = id->infog[0];
    if (code == -8 || code == -9 || code == -17 || code == -20) {
        /* The workspace was too small: INFOG is the same on all ranks. */
        id->icntl[13] = MORE_WORKSPACE;
        dmumps_c(id);
    }
    info[0] = id->infog[0];
    info[1] = id->infog[1];
    info[2] = id->infog[11];
    info[3] = id->info[0];
    id->irn_loc = id->jcn_loc = id->perm_in = id->listvar_schur = NULL;
    id->a_loc = id->schur = NULL;
}

/* Solves with what was eliminated; entries of the others are 0 afterwards. `info` gets INFOG(1)
 * and INFOG(2). */
void brinell_mumps_solve(int index, double *load, int info[2]) {
    DMUMPS_STRUC_C *id = all[index];
    id->rhs = load;
    id->nrhs = 1;
    id->lrhs = id->n;
    id->job = 3;
    dmumps_c(id);
    id->rhs = NULL;
    info[0] = id->infog[0];
    info[1] = id->infog[1];
}

void brinell_mumps_free(int index) {
    DMUMPS_STRUC_C *id = index < n_all ? all[index] : NULL;
    if (!id) return;
    id->job = -2;
    dmumps_c(id);
    free(id);
    all[index] = NULL;
}
