/* The C interface of brinell: elastoplastic contact without friction.
 *
 * Generated from src/capi by cbindgen; do not edit. To write it anew:
 *     BRINELL_WRITE_HEADER=1 cargo test --test all header
 *
 * Every function returns BRINELL_OK or a status; brinell_last_error() then states why, in the
 * thread that called. Handles are opaque and freed by their own function. Set the size of a
 * structure (sizeof) before handing it over. Handles may be used in different threads at once,
 * one handle by one thread at a time. See ffi/README.md.
 */

#ifndef BRINELL_H
#define BRINELL_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

// The call succeeded.
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

// The run is complete, but a state's quality misses its tolerance, an accuracy that the scene
// demands was not reached, or the message names another reason not to trust the results.
#define BRINELL_INACCURATE 7

// Contact reached the end of the contact candidates, although the bodies extend beyond it.
#define BRINELL_OUTGROWN 8

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

// Sparse Cholesky in pure Rust (faer).
#define BRINELL_BACKEND_FAER 3

// No strain out of the plane; forces per unit thickness.
#define BRINELL_PLANE_STRAIN 0

// No stress out of the plane; forces per unit thickness.
#define BRINELL_PLANE_STRESS 1

// Coordinates are (r, z); forces are totals over the full circle.
#define BRINELL_AXISYMMETRIC 2

// Three coordinates.
#define BRINELL_SOLID 3

// A triangle of three corners.
#define BRINELL_SHAPE_TRI3 0

// Three corners, then the mid-side nodes, the first between corners 0 and 1.
#define BRINELL_SHAPE_TRI6 1

// A quadrilateral of four corners.
#define BRINELL_SHAPE_QUAD4 2

// Four corners, then the mid-side nodes.
#define BRINELL_SHAPE_QUAD8 3

// Four corners: 0, 1, 2 counter-clockwise seen from 3.
#define BRINELL_SHAPE_TET4 4

// Four corners, then the middles of the edges 01, 12, 02, 03, 13, 23.
#define BRINELL_SHAPE_TET10 5

// Eight corners: the base counter-clockwise seen from the top, then the top.
#define BRINELL_SHAPE_HEX8 6

// Eight corners, then the middles of the edges of base, top, and between them.
#define BRINELL_SHAPE_HEX20 7

// Linear prism of six nodes.
#define BRINELL_SHAPE_PRISM6 8

// Quadratic prism of fifteen nodes.
#define BRINELL_SHAPE_PRISM15 9

// Undeformed x (r) of the pair, on the second surface.
#define BRINELL_PAIR_X 0

// Undeformed y (z).
#define BRINELL_PAIR_Y 1

// Gap of the pair, >= 0.
#define BRINELL_PAIR_GAP 2

// Force, compressive positive.
#define BRINELL_PAIR_FORCE 3

// Area that belongs to the pair.
#define BRINELL_PAIR_AREA 4

// Pressure, compressive positive.
#define BRINELL_PAIR_PRESSURE 5

// 1 if the pair is closed, 0 if it is open.
#define BRINELL_PAIR_CLOSED 6

// Undeformed z of the pair in a solid.
#define BRINELL_PAIR_Z 7

// Displacements, n_nodes x 2 components (n_nodes x 3 in a solid), node by node.
#define BRINELL_FIELD_DISPLACEMENT 0

// Mean stresses of the elements, n_elements x 4 components: xx, yy, zz, xy (axisymmetric rr, zz,
// tt, rz). In a solid n_elements x 6: xx, yy, zz, xy, yz, zx.
#define BRINELL_FIELD_STRESS 1

// n_elements von Mises stresses.
#define BRINELL_FIELD_VON_MISES 2

// n_elements equivalent plastic strains.
#define BRINELL_FIELD_PLASTIC_STRAIN 3

// Load factor at the end of each increment.
#define BRINELL_HISTORY_ALPHA 0

// Total load at the end of each increment.
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

// A model that is being put together from arrays.
typedef struct brinell_model brinell_model;

// What a run computed.
typedef struct brinell_results brinell_results;

// A scene: what is pressed on what.
typedef struct brinell_scene brinell_scene;

// A stiffness with contact rows, factored and condensed.
typedef struct brinell_structure brinell_structure;

// Options of the computation. NULL stands for the defaults, which are all zeros.
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
  // Load factor at the end of the increment, in the program's unit.
  double alpha;
  // Total load at the end of the increment.
  double load;
  // Largest contact pressure.
  double max_pressure;
  // Contact half width.
  double half_width;
  // Sum of the contact forces.
  double contact_force;
  // Number of closed pairs.
  uint64_t closed_pairs;
  // Number of Gauss points with plastic strain.
  uint64_t plastic_points;
  // Largest equivalent plastic strain.
  double max_equivalent_plastic_strain;
  // Share of the load program that has been run.
  double fraction;
  // Event that ended the increment, such as "closes: pair 12". Valid during the call only.
  const char *event;
} brinell_increment;

// Called in the calling thread after each accepted increment; anything but 0 stops the run there.
typedef int32_t (*brinell_callback)(const struct brinell_increment *increment, void *user);

// First yield. Numbers that are not known are NaN.
typedef struct brinell_yield {
  // sizeof(brinell_yield).
  size_t size;
  // Factor on the scene's proportional loads.
  double alpha;
  // Total load at first yield.
  double load;
  // Largest contact pressure.
  double max_pressure;
  // Contact half width.
  double half_width;
  // Coordinate x (r) of the point that yields first.
  double x;
  // Coordinate y (z) of the point that yields first.
  double y;
  // Number of the body that yields, from 0.
  uint64_t body;
  // Coordinate z of the point that yields first, in a solid.
  double z;
} brinell_yield;

// The state at a target.
typedef struct brinell_state {
  // sizeof(brinell_state).
  size_t size;
  // Load factor in the program's unit.
  double alpha;
  // Total load in this state.
  double load;
  // Sum of the contact forces.
  double contact_force;
  // Largest contact pressure.
  double max_pressure;
  // Contact half width.
  double half_width;
  // Depth of the residual dent.
  double residual_depth;
  // Relative approach of the bodies; for a single load the mean displacement of the loaded
  // surface along the load.
  double approach;
  // Largest equivalent plastic strain.
  double max_equivalent_plastic_strain;
  // Number of Gauss points with plastic strain.
  uint64_t plastic_points;
  // Number of contact pairs.
  uint64_t n_pairs;
  // 1 if the state has fields, otherwise 0.
  int32_t has_fields;
} brinell_state;

// The mesh, not copied: the arrays are valid as long as the results.
typedef struct brinell_mesh {
  // sizeof(brinell_mesh).
  size_t size;
  // Number of nodes.
  size_t n_nodes;
  // Number of elements.
  size_t n_elements;
  // Coordinates, n_nodes x 2 (n_nodes x 3 in a solid), node by node.
  const double *coordinates;
  // Nodes of all elements, one element after the other.
  const uint32_t *connectivity;
  // n_elements + 1 starts of the elements' nodes in the connectivity.
  const size_t *offsets;
  // Number of the body of each element, from 0; n_elements values.
  const uint32_t *element_body;
} brinell_mesh;

// A contact patch of a solid. If the patch reaches planes of symmetry, the figures are those of
// the whole patch, mirror images included.
typedef struct brinell_patch {
  // sizeof(brinell_patch).
  size_t size;
  // Number of the contact in the scene, from 0.
  uint64_t contact;
  // Area, projected on the plane perpendicular to the mean normal; for a patch that closes round
  // a body the area of its surface.
  double area;
  // Centroid of the area.
  double centroid[3];
  // Half axes, the larger first, of the ellipse with the same moments of area.
  double semi_axes[2];
  // Direction of the larger half axis.
  double direction[3];
  // Largest pressure.
  double max_pressure;
  // Force over area.
  double mean_pressure;
  // Force that the patch carries.
  double force;
} brinell_patch;

// A sparse symmetric matrix, compressed by column; repeated entries are added.
typedef struct brinell_matrix {
  // sizeof(brinell_matrix).
  size_t size;
  // Number of rows and columns.
  size_t n;
  // n + 1 starts of the columns in rows and values.
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
  // n_rows + 1 starts of the rows in freedoms and coefficients.
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

// The message of the last failure in this thread, UTF-8; empty before the first one. Valid until
// the next failure in this thread.
const char *brinell_last_error(void);

// The version of the library, such as "0.1.0". Static.
const char *brinell_version(void);

// The version of this interface: raised where a program built against an older header would break.
uint32_t brinell_abi_version(void);

// Reads a scene file and applies `n_overrides` texts "key.path=value" to it, as `--set` of the
// program does: tables are merged, "key=" removes a key; NULL and 0 for none.
int32_t brinell_scene_load(const char *path,
                           const char *const *overrides,
                           size_t n_overrides,
                           struct brinell_scene **out);

// Reads a scene from a text (TOML). Relative paths in it are relative to the working directory.
int32_t brinell_scene_parse(const char *toml, struct brinell_scene **out);

// Frees a scene.
void brinell_scene_free(struct brinell_scene *scene);

// Creates an empty model of the given kind: BRINELL_PLANE_STRAIN, BRINELL_PLANE_STRESS,
// BRINELL_AXISYMMETRIC or BRINELL_SOLID. `symmetry` is the number of copies of the model that make
// up the whole: 1 if the whole is meshed, 2 for a half model, 4 for a quarter of a plane or solid
// model, 8 for an eighth of a solid model. Loads and results are those of the whole.
int32_t brinell_model_new(int32_t kind, size_t symmetry, struct brinell_model **out);

// Frees a model.
void brinell_model_free(struct brinell_model *model);

// Adds nodes with n x 2 coordinates (n x 3 in a solid), node by node. Nodes are numbered from 0 in
// the order in which they were added.
int32_t brinell_model_nodes(struct brinell_model *model, const double *coordinates, size_t n);

// Adds `n` elements of one shape (BRINELL_SHAPE_...) to a body. `nodes` holds the nodes of one
// element after the other, each in the order of the shape.
int32_t brinell_model_elements(struct brinell_model *model,
                               const char *body,
                               int32_t shape,
                               const int64_t *nodes,
                               size_t n);

// Adds a named set of nodes.
int32_t brinell_model_node_set(struct brinell_model *model, const char *name, const int64_t *nodes, size_t n);

// Adds a named surface of n facets, each given by its element and its local number in the element.
// In the plane, facet k lies between corners k and k + 1.
int32_t brinell_model_surface(struct brinell_model *model,
                              const char *name,
                              const int64_t *elements,
                              const int64_t *facets,
                              size_t n);

// Adds a named surface by its nodes, mid-side nodes included. The surface consists of all boundary
// facets that have no other nodes than the given ones.
int32_t brinell_model_surface_of_nodes(struct brinell_model *model,
                                       const char *name,
                                       const int64_t *nodes,
                                       size_t n);

// States that a surface is a circle about (x, y): the body lies inside (`outward` 1) or outside of
// it (0, a hole). Normals are then exact.
int32_t brinell_model_circle(struct brinell_model *model,
                             const char *surface,
                             double x,
                             double y,
                             double radius,
                             int32_t outward);

// Runs the load program of a model; otherwise like brinell_run. The model may be changed and run
// again.
int32_t brinell_model_run(const struct brinell_model *model,
                          const struct brinell_options *options,
                          brinell_callback callback,
                          void *user,
                          struct brinell_results **out);

// Adds tables of a scene (TOML text): materials, bodies, rigid, contact, tie, equation, support,
// load, program, analysis, units, title. Materials, bodies, rigid surfaces, contacts, ties,
// equations, supports and loads are added to the existing ones; the other tables replace the
// existing ones. A model without a target gets one target, at load factor 1.
int32_t brinell_model_tables(struct brinell_model *model, const char *tables);

// Lets two surfaces touch at n given pairs of nodes. `contact` has the keys of a `[[contact]]`
// table (TOML text): `first`, `second` and any other keys. Nodes of the surfaces that are in no
// pair do not touch.
//
// `normals` holds the direction of each pair from the second body to the first, n x 2 components
// (n x 3 in a solid); NULL for the outward normals of the second surface. `gaps` holds n gaps >=
// 0; NULL for the contact's key `gap` or, without this key, for the geometric gaps.
int32_t brinell_model_contact_pairs(struct brinell_model *model,
                                    const char *contact,
                                    size_t n,
                                    const int64_t *first_nodes,
                                    const int64_t *second_nodes,
                                    const double *normals,
                                    const double *gaps);

// Adds a load with a force of its own on each of n nodes: n x 2 components (n x 3 in a solid). The
// forces act on the meshed part of a symmetric model, not on the whole. `load` has keys of a
// `[[load]]` table (TOML text): `name` and, unless the load is proportional, `history`.
int32_t brinell_model_nodal_load(struct brinell_model *model,
                                 const char *load,
                                 size_t n,
                                 const int64_t *nodes,
                                 const double *forces);

// Runs a scene's load program. `callback` (NULL for none) is called after each increment with
// `user`.
//
// A run that ends early after increments were accepted returns the status of the reason, such as
// BRINELL_STOPPED, BRINELL_COLLAPSE, BRINELL_OUTGROWN or BRINELL_ANALYSIS, *and* the results
// computed up to then. A complete run returns BRINELL_INACCURATE and results if the quality of a
// state misses its tolerance, if the accuracy that the scene demands is not reached, or for
// another reason that the message names. After any other failure `*out` is NULL.
//
// A scene with the key `accuracy` is run on finer and finer meshes until the stated errors are
// within the demand. The callback receives the increments of each run, counted anew from 1. The
// results are those of the last mesh; `accuracy` in the summary lists the stated error of each
// figure, and the reason if the demand was not reached.
int32_t brinell_run(const struct brinell_scene *scene,
                    const struct brinell_options *options,
                    brinell_callback callback,
                    void *user,
                    struct brinell_results **out);

// Frees results; arrays taken from them are no longer valid.
void brinell_results_free(struct brinell_results *results);

// Number of states; 0 for NULL.
size_t brinell_results_n_states(const struct brinell_results *results);

// First yield. The status is BRINELL_INPUT if the run has no first yield.
int32_t brinell_results_yield(const struct brinell_results *results, struct brinell_yield *out);

// The main figures of state `index`, from 0; brinell_results_value gives every figure.
int32_t brinell_results_state(const struct brinell_results *results, size_t index, struct brinell_state *out);

// The name of state `index`; NULL if there is no such state. Valid as long as the results.
const char *brinell_results_state_name(const struct brinell_results *results, size_t index);

// An array of the contact pairs of state `index`: one of BRINELL_PAIR_... Valid as long as the
// results.
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

// A column of the history, a value for each accepted increment: one of BRINELL_HISTORY_... Valid
// as long as the results.
int32_t brinell_results_history(const struct brinell_results *results,
                                int32_t which,
                                const double **data,
                                size_t *n);

// The mesh of the run.
int32_t brinell_results_mesh(const struct brinell_results *results, struct brinell_mesh *out);

// Writes the result directory that the program writes: tables, fields, report.
int32_t brinell_results_write(const struct brinell_results *results, const char *dir);

// Number of the quantities that a state has.
size_t brinell_n_quantities(void);

// The key of quantity `index`, from 0, as in summary.json: "load", "half_width", "residual_depth"
// and so on; NULL if there is no such quantity. Static.
const char *brinell_quantity_key(size_t index);

// A number of the results by its path in summary.json: "yield.KEY" at first yield, or
// "states.NAME.KEY" of a state, where the number of the state, from 0, may stand for its name.
// Counts are numbers too; a number that is not known is NaN. The status is BRINELL_INPUT if the
// results have no such number.
int32_t brinell_results_value(const struct brinell_results *results, const char *path, double *value);

// Number of contact patches of a solid in state `index`; 0 if there is no such state.
size_t brinell_results_n_patches(const struct brinell_results *results, size_t index);

// A contact patch of state `index`; `index` and `patch` count from 0.
int32_t brinell_results_patch(const struct brinell_results *results,
                              size_t index,
                              size_t patch,
                              struct brinell_patch *out);

// Factors and condenses a stiffness with contact rows (NULL for none). The arrays are not needed
// afterwards. The initial state is that without load.
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

// The stiffness condensed on the contact freedoms, n x n, column by column. Valid as long as the
// structure.
int32_t brinell_structure_condensed(const struct brinell_structure *structure,
                                    const double **data,
                                    size_t *n);

// Solves contact under a load on all freedoms, which includes any plastic loads.
int32_t brinell_structure_solve(struct brinell_structure *structure, const double *load, size_t n);

// Starts a piece of the load path: from the current state on the load is load + t rate, with t
// from 0.
int32_t brinell_structure_start(struct brinell_structure *structure, const double *rate, size_t n);

// Goes on to `end` or to the next change of contact, whichever comes first. `t` receives the
// position, `n_changes` the number of rows that change there, 0 at the end.
int32_t brinell_structure_step(struct brinell_structure *structure, double end, double *t, size_t *n_changes);

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

// Displacements of all freedoms. Costs one full solve. `backward_error` (NULL if not wanted)
// receives the backward error of this solve.
int32_t brinell_structure_displacements(const struct brinell_structure *structure,
                                        double *u,
                                        size_t n,
                                        double *backward_error);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* BRINELL_H */
