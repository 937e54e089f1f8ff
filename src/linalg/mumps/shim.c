/* MUMPS over MPI behind a dozen numbers: its structure changes from version to version and is known
 * here alone. Rank 0 is the program; the others wait for commands, each a call of MUMPS that all
 * ranks make together.
 */
#include <dmumps_c.h>
#include <mpi.h>
#include <stdint.h>
#include <stdlib.h>
#include <time.h>

enum command { QUIT, CREATE, FACTOR, SOLVE, FREE };

static const int TAG = 4711;
static const int USE_COMM_WORLD = -987654;
static DMUMPS_STRUC_C **all;
static int n_all;
static int n_ranks = 1;
static int is_ours;

/* What every rank does at a command. Returns 0 where the memory does not suffice. */
static int obey(enum command command, int index) {
    DMUMPS_STRUC_C *id;
    if (command == CREATE) {
        DMUMPS_STRUC_C **more = realloc(all, (index + 1) * sizeof *all);
        if (!more) return 0;
        all = more;
        for (; n_all <= index; ++n_all) all[n_all] = NULL;
        id = all[index] = calloc(1, sizeof *id);
        if (!id) return 0;
        id->par = 1;
        id->sym = 1;
        id->comm_fortran = USE_COMM_WORLD;
        id->job = -1;
        dmumps_c(id);
        for (int unit = 0; unit < 4; ++unit) id->icntl[unit] = 0;
        return 1;
    }
    id = all[index];
    if (!id) return 0;
    id->job = command == FACTOR ? 4 : command == SOLVE ? 3 : -2;
    dmumps_c(id);
    if (command == FREE) {
        free(id);
        all[index] = NULL;
    }
    return 1;
}

static int tell(enum command command, int index) {
    int message[2] = {command, index};
    for (int rank = 1; rank < n_ranks; ++rank)
        MPI_Send(message, 2, MPI_INT, rank, TAG, MPI_COMM_WORLD);
    return command == QUIT || obey(command, index);
}

/* Joins the other ranks, or is alone. */
int brinell_mpi_begin(int *rank, int *size) {
    int begun = 0, provided = 0;
    if (MPI_Initialized(&begun) != MPI_SUCCESS) return 0;
    if (!begun) {
        if (MPI_Init_thread(NULL, NULL, MPI_THREAD_SERIALIZED, &provided) != MPI_SUCCESS) return 0;
        is_ours = 1;
    }
    MPI_Comm_rank(MPI_COMM_WORLD, rank);
    MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
    *size = n_ranks;
    return 1;
}

/* What ranks beyond the first do until that has ended. Waiting leaves the processor to others. */
void brinell_mpi_serve(void) {
    const struct timespec pause = {0, 500000};
    for (;;) {
        int message[2], there = 0;
        while (!there) {
            MPI_Iprobe(0, TAG, MPI_COMM_WORLD, &there, MPI_STATUS_IGNORE);
            if (!there) nanosleep(&pause, NULL);
        }
        MPI_Recv(message, 2, MPI_INT, 0, TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        if (message[0] == QUIT) return;
        if (!obey(message[0], message[1])) MPI_Abort(MPI_COMM_WORLD, 5);
    }
}

/* The others are let go. */
void brinell_mpi_end(int is_first) {
    int ended = 0;
    MPI_Finalized(&ended);
    if (ended) return;
    if (is_first) tell(QUIT, 0);
    if (is_ours) MPI_Finalize();
}

/* Factors a symmetric positive definite matrix of triplets (from 1, one triangle) in the order
 * `place`, the last `n_schur` variables of which, listed in `schur_list` as they come, are not
 * eliminated: `schur` gets their matrix by rows, its lower triangle. Returns a handle, or -1 without
 * memory; `info` gets INFOG(1), INFOG(2) and INFOG(7). */
int brinell_mumps_factor(int n, int64_t n_entries, int *rows, int *columns, double *values,
                         int *place, int n_schur, int *schur_list, double *schur, int info[3]) {
    int index = 0;
    while (index < n_all && all[index]) ++index;
    if (!tell(CREATE, index)) return -1;
    DMUMPS_STRUC_C *id = all[index];
    id->n = n;
    id->nnz = n_entries;
    id->irn = rows;
    id->jcn = columns;
    id->a = values;
    id->perm_in = place;
    id->icntl[6] = 1;   /* ICNTL(7): the order is given */
    id->icntl[27] = 1;  /* ICNTL(28): sequential analysis */
    id->icntl[13] = 40; /* ICNTL(14): workspace beyond what is estimated, in per cent */
    if (n_schur > 0) {
        id->icntl[18] = 1; /* ICNTL(19): the Schur complement on rank 0 */
        id->size_schur = n_schur;
        id->listvar_schur = schur_list;
        id->schur = schur;
    }
    tell(FACTOR, index);
    info[0] = id->infog[0];
    info[1] = id->infog[1];
    info[2] = id->infog[6];
    id->irn = id->jcn = id->perm_in = id->listvar_schur = NULL;
    id->a = id->schur = NULL;
    return index;
}

/* Solves with what was eliminated; entries of the others are 0 afterwards. */
void brinell_mumps_solve(int index, double *load, int info[2]) {
    DMUMPS_STRUC_C *id = all[index];
    id->rhs = load;
    id->nrhs = 1;
    id->lrhs = id->n;
    tell(SOLVE, index);
    id->rhs = NULL;
    info[0] = id->infog[0];
    info[1] = id->infog[1];
}

void brinell_mumps_free(int index) {
    tell(FREE, index);
}
