/* Presses and releases a ball through the whole library, builds a model of two blocks from arrays, and follows two springs and a
 * wall at the lower level.
 *
 * Build against the installed library:
 *     cc indentation.c -o indentation $(pkg-config --cflags --libs brinell)
 * Run: ./indentation SCENE
 * ffi/examples/indentation.rs prints the same lines through the Rust crate. */
#include <brinell.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

static void check(int status, const char *what) {
    if (status != BRINELL_OK) {
        fprintf(stderr, "%s: status %d: %s\n", what, status, brinell_last_error());
        exit(1);
    }
}

static int count(const brinell_increment *increment, void *user) {
    (void)increment;
    ++*(size_t *)user;
    return 0;
}

static int stop_at_third(const brinell_increment *increment, void *user) {
    (void)user;
    return increment->number >= 3;
}

/* What one analysis gives, so that two threads can be compared. */
struct figures {
    const char *scene;
    size_t increments, n_states;
    double yield_load, largest_pressure, dent, displacement;
};

static void *analyse(void *user) {
    struct figures *figures = user;
    brinell_scene *scene = NULL;
    brinell_results *results = NULL;
    const char *overrides[] = {"mesh.cylinder_on_half_plane.resolution=6"};
    check(brinell_scene_load(figures->scene, overrides, 1, &scene), "load");
    check(brinell_run(scene, NULL, count, &figures->increments, &results), "run");
    brinell_scene_free(scene);

    brinell_yield yield = {.size = sizeof yield};
    check(brinell_results_yield(results, &yield), "yield");
    figures->yield_load = yield.load;
    figures->n_states = brinell_results_n_states(results);
    const double *values;
    size_t n;
    check(brinell_results_history(results, BRINELL_HISTORY_MAX_PRESSURE, &values, &n), "history");
    for (size_t i = 0; i < n; ++i)
        if (values[i] > figures->largest_pressure) figures->largest_pressure = values[i];
    brinell_state state = {.size = sizeof state};
    check(brinell_results_state(results, figures->n_states - 1, &state), "state");
    figures->dent = state.residual_depth;
    check(brinell_results_field(results, figures->n_states - 1, BRINELL_FIELD_DISPLACEMENT, &values, &n), "field");
    for (size_t i = 0; i < n; ++i)
        figures->displacement += values[i] * values[i];
    brinell_results_free(results);
    return NULL;
}

/* Half of two blocks from arrays: pairs with gaps that grow from the middle, pressed together until they flow, and let go. */
enum { NX = 4, NY = 2, ROW = NX + 1, EACH = ROW * (NY + 1) };

static int64_t node(int body, int i, int j) { return body * EACH + j * ROW + i; }

static void blocks(void) {
    brinell_model *model = NULL;
    check(brinell_model_new(BRINELL_PLANE_STRAIN, 2, &model), "model");
    const char *names[] = {"lower", "upper"};
    int64_t middle[2 * (NY + 1)], rows[4][ROW];
    double gaps[ROW];
    for (int body = 0; body < 2; ++body) {
        double coordinates[2 * EACH];
        int64_t elements[4 * NX * NY], *next = elements;
        for (int j = 0; j <= NY; ++j)
            for (int i = 0; i <= NX; ++i) {
                coordinates[2 * (j * ROW + i)] = 0.5 * i;
                coordinates[2 * (j * ROW + i) + 1] = body + 0.5 * j;
            }
        for (int j = 0; j < NY; ++j)
            for (int i = 0; i < NX; ++i) {
                *next++ = node(body, i, j);
                *next++ = node(body, i + 1, j);
                *next++ = node(body, i + 1, j + 1);
                *next++ = node(body, i, j + 1);
            }
        for (int j = 0; j <= NY; ++j) middle[body * (NY + 1) + j] = node(body, 0, j);
        check(brinell_model_nodes(model, coordinates, EACH), "nodes");
        check(brinell_model_elements(model, names[body], BRINELL_SHAPE_QUAD4, elements, NX * NY), "elements");
    }
    for (int i = 0; i <= NX; ++i) {
        rows[0][i] = node(0, i, 0);
        rows[1][i] = node(0, i, NY);
        rows[2][i] = node(1, i, 0);
        rows[3][i] = node(1, i, NY);
        gaps[i] = 0.002 * (0.5 * i) * (0.5 * i);
    }
    const char *surfaces[] = {"floor", "face", "opposite", "top"};
    for (int k = 0; k < 4; ++k)
        check(brinell_model_surface_of_nodes(model, surfaces[k], rows[k], ROW), "surface");
    check(brinell_model_node_set(model, "middle", middle, 2 * (NY + 1)), "node set");
    /* Arrays for the mesh and the pairs, scene text for all else. */
    check(brinell_model_contact_pairs(model, "first = 'opposite'\nsecond = 'face'", ROW, rows[2], rows[1], NULL, gaps),
          "contact");
    check(brinell_model_tables(model,
                               "bodies = { lower = { material = 'steel' }, upper = { material = 'steel' } }\n"
                               "support = [{ on = 'floor', fix = ['y'] }, { on = 'middle', fix = ['x'] }]\n"
                               "load = [{ on = 'top', pressure = 300 }]\n"
                               "program.targets = [{ load_factor = 1.0 }, { load_factor = 0.0 }]\n"
                               "[materials.steel]\n"
                               "youngs_modulus = 210e3\n"
                               "poissons_ratio = 0.3\n"
                               "yield_stress = 300\n"
                               "plastic_modulus = 2100\n"),
          "tables");
    brinell_results *results = NULL;
    check(brinell_model_run(model, NULL, NULL, NULL, &results), "run");
    brinell_model_free(model);
    brinell_state state = {.size = sizeof state};
    check(brinell_results_state(results, 0, &state), "state");
    printf("blocks: contact force %.15e, largest pressure %.15e, points that flow %llu\n", state.contact_force,
           state.max_pressure, (unsigned long long)state.plastic_points);
    const double *left;
    size_t n;
    check(brinell_results_pairs(results, 1, BRINELL_PAIR_GAP, &left, &n), "gaps");
    printf("gaps left:");
    for (size_t k = 0; k < n; ++k) printf(" %.15e", left[k]);
    printf("\n");
    brinell_results_free(results);
}

/* Freedoms 0-1-2 in a row, unit springs between them, 0 tied to the ground; a wall at distance 1 before freedom 2. */
static void springs(void) {
    const int64_t column_starts[] = {0, 1, 3, 5}, rows[] = {0, 0, 1, 1, 2};
    const double values[] = {2, -1, 2, -1, 1};
    const int64_t row_starts[] = {0, 1}, freedoms[] = {2};
    const double coefficients[] = {1}, gaps[] = {1}, rate[] = {0, 0, 1};
    brinell_matrix matrix = {sizeof matrix, 3, column_starts, rows, values, BRINELL_TRIANGLE_UPPER};
    brinell_rows contact = {sizeof contact, 1, row_starts, freedoms, coefficients, gaps};
    brinell_structure *structure = NULL;
    check(brinell_structure_new(&matrix, &contact, NULL, &structure), "structure");
    const double *data;
    size_t n, changes, row;
    int32_t closes;
    double t;
    check(brinell_structure_condensed(structure, &data, &n), "condensed");
    printf("condensed stiffness %zu x %zu: %.15e\n", n, n, data[0]);
    check(brinell_structure_start(structure, rate, 3), "start");
    check(brinell_structure_step(structure, 2.0, &t, &changes), "step");
    check(brinell_structure_change(structure, 0, &row, &closes), "change");
    printf("row %zu %s at t = %.15e\n", row, closes ? "closes" : "opens", t);
    check(brinell_structure_step(structure, 2.0, &t, &changes), "step");
    check(brinell_structure_forces(structure, &data, &n), "forces");
    printf("force at t = %.15e: %.15e\n", t, data[0]);
    double u[3];
    int32_t closed;
    check(brinell_structure_displacements(structure, u, 3, NULL), "displacements");
    check(brinell_structure_statuses(structure, &closed, 1), "statuses");
    printf("displacements %.15e %.15e %.15e, closed %d\n", u[0], u[1], u[2], closed);
    brinell_structure_free(structure);
}

int main(int argc, char **argv) {
    if (argc != 2) {
        fprintf(stderr, "usage: %s SCENE\n", argv[0]);
        return 2;
    }
    /* Two analyses in two threads at once. */
    struct figures figures[2] = {{.scene = argv[1]}, {.scene = argv[1]}};
    pthread_t other;
    if (pthread_create(&other, NULL, analyse, &figures[1])) return 1;
    analyse(&figures[0]);
    pthread_join(other, NULL);
    for (int i = 0; i < 2; ++i)
        printf("increments %zu, states %zu, yield load %.15e, largest pressure %.15e, dent %.15e, displacement %.15e\n",
               figures[i].increments, figures[i].n_states, figures[i].yield_load, figures[i].largest_pressure,
               figures[i].dent, figures[i].displacement);

    /* A callback that stops, and an error with its reason. */
    brinell_scene *scene = NULL;
    brinell_results *results = NULL;
    check(brinell_scene_load(argv[1], NULL, 0, &scene), "load");
    int status = brinell_run(scene, NULL, stop_at_third, NULL, &results);
    const double *alpha;
    size_t n;
    check(brinell_results_history(results, BRINELL_HISTORY_ALPHA, &alpha, &n), "history");
    printf("stopped with status %d after %zu increments\n", status, n);
    brinell_results_free(results);
    brinell_scene_free(scene);
    status = brinell_scene_parse("kind = 3", &scene);
    printf("refused with status %d: %s\n", status, brinell_last_error());
    blocks();
    springs();
    return 0;
}
