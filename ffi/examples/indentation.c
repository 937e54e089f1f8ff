/* Presses and releases a ball through the whole library, and follows two springs and a wall at the lower level.
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
    springs();
    return 0;
}
