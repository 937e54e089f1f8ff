/* The C interface of brinell: elastoplastic contact without friction.
 *
 * Generated from src/capi by cbindgen; do not edit. To write it anew:
 *     BRINELL_WRITE_HEADER=1 cargo test --test capi header
 *
 * Every function returns BRINELL_OK or a status; brinell_last_error() then says why, in the thread that called.
 * Handles are opaque and freed by their own function. Set the size of a structure (sizeof) before handing it over.
 * Handles may be used in different threads at once, one handle by one thread at a time. See ffi/README.md.
 */

#ifndef BRINELL_H
#define BRINELL_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

// Done.
#define BRINELL_OK 0

// An argument, the scene or the mesh is wrong, or asks for an effect that brinell does not have.
#define BRINELL_INPUT 2

// A file could not be read or written.
#define BRINELL_IO 3

// The model is not held: a body can move freely.
#define BRINELL_UNHELD 4

// The analysis failed: a solve did not converge or a target was not reached.
#define BRINELL_ANALYSIS 5

// The load passed the limit load.
#define BRINELL_COLLAPSE 6

// The run is complete, but a state's quality misses its tolerance.
#define BRINELL_INACCURATE 7

// A fault of brinell itself.
#define BRINELL_INTERNAL 70

// The callback stopped the run.
#define BRINELL_STOPPED 130

// The backend that the library was built for.
#define BRINELL_BACKEND_DEFAULT 0

// Sparse Cholesky of SuiteSparse.
#define BRINELL_BACKEND_CHOLMOD 1

// Dense, by the textbook: a reference for small models.
#define BRINELL_BACKEND_DENSE 2

// Undeformed x (r) of the pair, on the second surface.
#define BRINELL_PAIR_X 0

// Undeformed y (z).
#define BRINELL_PAIR_Y 1

// Gap, >= 0.
#define BRINELL_PAIR_GAP 2

// Force, compressive positive.
#define BRINELL_PAIR_FORCE 3

// Area that belongs to the pair.
#define BRINELL_PAIR_AREA 4

// Pressure, compressive positive.
#define BRINELL_PAIR_PRESSURE 5

// 1 where closed, 0 where open.
#define BRINELL_PAIR_CLOSED 6

// n_nodes x 2 displacements, node by node.
#define BRINELL_FIELD_DISPLACEMENT 0

// n_elements x 4 mean stresses: xx, yy, zz, xy (axisymmetric rr, zz, tt, rz).
#define BRINELL_FIELD_STRESS 1

// n_elements von Mises stresses.
#define BRINELL_FIELD_VON_MISES 2

// n_elements equivalent plastic strains.
#define BRINELL_FIELD_PLASTIC_STRAIN 3

// Load factor at the end of each increment.
#define BRINELL_HISTORY_ALPHA 0

// Total load.
#define BRINELL_HISTORY_LOAD 1

// Largest contact pressure.
#define BRINELL_HISTORY_MAX_PRESSURE 2

// Contact half width.
#define BRINELL_HISTORY_HALF_WIDTH 3

// Sum of the contact forces.
#define BRINELL_HISTORY_CONTACT_FORCE 4

// Largest equivalent plastic strain.
#define BRINELL_HISTORY_PLASTIC_STRAIN 5

// Relative out-of-balance force.
#define BRINELL_HISTORY_RESIDUAL 6

// Both triangles are given; the upper one is read.
#define BRINELL_TRIANGLE_BOTH 0

// The upper triangle (row <= column) is given.
#define BRINELL_TRIANGLE_UPPER 1

// The lower triangle (row >= column) is given.
#define BRINELL_TRIANGLE_LOWER 2

// What a run computed.
typedef struct brinell_results brinell_results;

// A scene: what is pressed on what.
typedef struct brinell_scene brinell_scene;

// A stiffness with contact rows, factored and condensed.
typedef struct brinell_structure brinell_structure;

// How to compute. NULL stands for the defaults, which are all zeros.
typedef struct brinell_options {
  // sizeof(brinell_options).
  size_t size;
  // One of BRINELL_BACKEND_...
  int32_t backend;
} brinell_options;

// An accepted increment.
typedef struct brinell_increment {
  // sizeof(brinell_increment) of the library.
  size_t size;
  // Number, from 1.
  uint64_t number;
  // Load factor at its end, in the program's unit.
  double alpha;
  // Total load.
  double load;
  // Largest contact pressure.
  double max_pressure;
  // Contact half width.
  double half_width;
  // Sum of the contact forces.
  double contact_force;
  // Pairs that are closed.
  uint64_t closed_pairs;
  // Gauss points with plastic strain.
  uint64_t plastic_points;
  // Largest equivalent plastic strain.
  double max_equivalent_plastic_strain;
  // Share of the load program that lies behind.
  double fraction;
  // What ended it, such as "closes: pair 12". Valid during the call only.
  const char *event;
} brinell_increment;

// Called in the calling thread after each accepted increment; anything but 0 stops the run there.
typedef int32_t (*brinell_callback)(const struct brinell_increment *increment, void *user);

// First yield. Not a number where it is not known.
typedef struct brinell_yield {
  // sizeof(brinell_yield).
  size_t size;
  // Factor on the scene's proportional loads.
  double alpha;
  // Total load.
  double load;
  // Largest contact pressure.
  double max_pressure;
  // Contact half width.
  double half_width;
  // Where: x (r).
  double x;
  // Where: y (z).
  double y;
  // In which body.
  uint64_t body;
} brinell_yield;

// The state at a target.
typedef struct brinell_state {
  // sizeof(brinell_state).
  size_t size;
  // Load factor in the program's unit.
  double alpha;
  // Total load.
  double load;
  // Sum of the contact forces.
  double contact_force;
  // Largest contact pressure.
  double max_pressure;
  // Contact half width.
  double half_width;
  // The dent that stays.
  double residual_depth;
  // Displacement of the loaded surface along the load.
  double approach;
  // Largest equivalent plastic strain.
  double max_equivalent_plastic_strain;
  // Gauss points with plastic strain.
  uint64_t plastic_points;
  // Number of contact pairs.
  uint64_t n_pairs;
  // 1 where the state has fields.
  int32_t has_fields;
} brinell_state;

// The mesh, as it lies in memory: valid as long as the results.
typedef struct brinell_mesh {
  // sizeof(brinell_mesh).
  size_t size;
  // Number of nodes.
  size_t n_nodes;
  // Number of elements.
  size_t n_elements;
  // n_nodes x 2 coordinates, node by node.
  const double *coordinates;
  // Nodes of all elements, one element after the other.
  const uint32_t *connectivity;
  // n_elements + 1 begins of the elements' nodes in the connectivity.
  const size_t *offsets;
  // n_elements bodies.
  const uint32_t *element_body;
} brinell_mesh;

// A sparse symmetric matrix, compressed by column; repeated entries are added.
typedef struct brinell_matrix {
  // sizeof(brinell_matrix).
  size_t size;
  // Number of rows and columns.
  size_t n;
  // n + 1 begins of the columns in rows and values.
  const int64_t *column_starts;
  // Row of each entry, from 0.
  const int64_t *rows;
  // Value of each entry.
  const double *values;
  // One of BRINELL_TRIANGLE_...
  int32_t triangle;
} brinell_matrix;

// Contact rows B, compressed by row, and gaps delta: g = delta - B u >= 0.
typedef struct brinell_rows {
  // sizeof(brinell_rows).
  size_t size;
  // Number of rows.
  size_t n_rows;
  // n_rows + 1 begins of the rows in freedoms and coefficients.
  const int64_t *row_starts;
  // Freedom of each coefficient, from 0.
  const int64_t *freedoms;
  // The coefficients.
  const double *coefficients;
  // n_rows gaps without load; negative is interference.
  const double *gaps;
} brinell_rows;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The reason of the last failure in this thread, UTF-8; empty before the first one. Valid until the next failure in this thread.
const char *brinell_last_error(void);

// The version of the library, such as "0.1.0". Static.
const char *brinell_version(void);

// The version of this interface: raised where a program built against an older header would break.
uint32_t brinell_abi_version(void);

// Reads a scene file, with `n_overrides` texts "key.path=value" put over it (as `--set` of the program; NULL and 0 for none).
int32_t brinell_scene_load(const char *path,
                           const char *const *overrides,
                           size_t n_overrides,
                           struct brinell_scene **out);

// Reads a scene from a text (TOML). Relative paths in it are relative to the working directory.
int32_t brinell_scene_parse(const char *toml, struct brinell_scene **out);

// Frees a scene.
void brinell_scene_free(struct brinell_scene *scene);

// Runs a scene's load program. `callback` (NULL for none) is called after each increment with `user`.
//
// A run that was stopped, collapsed or failed after increments were accepted returns BRINELL_STOPPED, BRINELL_COLLAPSE or
// BRINELL_ANALYSIS *and* results: what was computed before; a complete one with a state whose quality misses its tolerance
// returns BRINELL_INACCURATE and results. After any other failure `*out` is NULL.
int32_t brinell_run(const struct brinell_scene *scene,
                    const struct brinell_options *options,
                    brinell_callback callback,
                    void *user,
                    struct brinell_results **out);

// Frees results; arrays taken from them are gone.
void brinell_results_free(struct brinell_results *results);

// Number of states; 0 for NULL.
size_t brinell_results_n_states(const struct brinell_results *results);

// First yield. BRINELL_INPUT where the run has none.
int32_t brinell_results_yield(const struct brinell_results *results, struct brinell_yield *out);

// The figures of state `index`, from 0.
int32_t brinell_results_state(const struct brinell_results *results, size_t index, struct brinell_state *out);

// The name of state `index`; NULL where there is no such state. Valid as long as the results.
const char *brinell_results_state_name(const struct brinell_results *results, size_t index);

// An array of the contact pairs of state `index`: one of BRINELL_PAIR_... Valid as long as the results.
int32_t brinell_results_pairs(const struct brinell_results *results,
                              size_t index,
                              int32_t which,
                              const double **data,
                              size_t *n);

// A field of state `index`: one of BRINELL_FIELD_... Not copied: valid as long as the results.
int32_t brinell_results_field(const struct brinell_results *results,
                              size_t index,
                              int32_t which,
                              const double **data,
                              size_t *n);

// A column of the history, a value for each accepted increment: one of BRINELL_HISTORY_... Valid as long as the results.
int32_t brinell_results_history(const struct brinell_results *results,
                                int32_t which,
                                const double **data,
                                size_t *n);

// The mesh of the run.
int32_t brinell_results_mesh(const struct brinell_results *results, struct brinell_mesh *out);

// Writes the result directory that the program writes: tables, fields, report.
int32_t brinell_results_write(const struct brinell_results *results, const char *dir);

// Factors and condenses a stiffness with contact rows (NULL for none). The arrays are not needed afterwards. The state is that
// without load.
int32_t brinell_structure_new(const struct brinell_matrix *matrix,
                              const struct brinell_rows *rows,
                              const struct brinell_options *options,
                              struct brinell_structure **out);

// Frees a structure.
void brinell_structure_free(struct brinell_structure *structure);

// The contact freedoms: those that occur in rows, ascending. Valid as long as the structure.
int32_t brinell_structure_contact_freedoms(const struct brinell_structure *structure,
                                           const size_t **data,
                                           size_t *n);

// The stiffness condensed on the contact freedoms, n x n, column by column. Valid as long as the structure.
int32_t brinell_structure_condensed(const struct brinell_structure *structure,
                                    const double **data,
                                    size_t *n);

// Solves contact under a load on all freedoms (plastic loads among them).
int32_t brinell_structure_solve(struct brinell_structure *structure, const double *load, size_t n);

// Starts a piece of the load path: from the state at hand the load goes on as load + t rate, t from 0.
int32_t brinell_structure_start(struct brinell_structure *structure, const double *rate, size_t n);

// Goes on to `end` or to the next change of contact: `t` is where, `n_changes` how many rows change there, 0 at the end.
int32_t brinell_structure_step(struct brinell_structure *structure,
                               double end,
                               double *t,
                               size_t *n_changes);

// Change `index` of the last event: its row, and whether it closes (1) or opens (0).
int32_t brinell_structure_change(const struct brinell_structure *structure,
                                 size_t index,
                                 size_t *row,
                                 int32_t *closes);

// Gaps of the rows, >= 0. Valid until the state changes.
int32_t brinell_structure_gaps(const struct brinell_structure *structure, const double **data, size_t *n);

// Forces of the rows, compressive positive. Valid until the state changes.
int32_t brinell_structure_forces(const struct brinell_structure *structure, const double **data, size_t *n);

// Statuses of the rows: 1 closed, 0 open.
int32_t brinell_structure_statuses(const struct brinell_structure *structure, int32_t *closed, size_t n);

// Displacements of all freedoms. Costs one full solve. `backward_error` (NULL if not wanted) is that of this solve.
int32_t brinell_structure_displacements(const struct brinell_structure *structure,
                                        double *u,
                                        size_t n,
                                        double *backward_error);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* BRINELL_H */
