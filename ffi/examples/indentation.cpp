// What indentation.c does, in C++ with owning pointers: the same lines.
//
//     c++ -std=c++17 indentation.cpp -o indentation $(pkg-config --cflags --libs brinell)
#include <brinell.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

void check(int status, const char *what) {
    if (status != BRINELL_OK) throw std::runtime_error(std::string(what) + ": " + brinell_last_error());
}

template <class T, void (*release)(T *)> struct Release {
    void operator()(T *handle) const { release(handle); }
};
template <class T, void (*release)(T *)> using Owned = std::unique_ptr<T, Release<T, release>>;
using Scene = Owned<brinell_scene, brinell_scene_free>;
using Results = Owned<brinell_results, brinell_results_free>;
using Model = Owned<brinell_model, brinell_model_free>;
using Structure = Owned<brinell_structure, brinell_structure_free>;

Scene load(const char *path, std::vector<const char *> overrides = {}) {
    brinell_scene *scene = nullptr;
    check(brinell_scene_load(path, overrides.data(), overrides.size(), &scene), "load");
    return Scene(scene);
}

struct Span {
    const double *data = nullptr;
    size_t n = 0;
    const double *begin() const { return data; }
    const double *end() const { return data + n; }
};

struct Figures {
    size_t increments = 0, n_states = 0;
    double yield_load = 0, largest_pressure = 0, dent = 0, displacement = 0;
};

Figures analyse(const char *path) {
    Figures figures;
    Scene scene = load(path, {"mesh.cylinder_on_half_plane.resolution=6"});
    brinell_results *out = nullptr;
    auto count = [](const brinell_increment *, void *user) -> int32_t {
        ++*static_cast<size_t *>(user);
        return 0;
    };
    check(brinell_run(scene.get(), nullptr, count, &figures.increments, &out), "run");
    Results results(out);
    brinell_yield yield{};
    yield.size = sizeof yield;
    check(brinell_results_yield(results.get(), &yield), "yield");
    figures.yield_load = yield.load;
    figures.n_states = brinell_results_n_states(results.get());
    Span pressures;
    check(brinell_results_history(results.get(), BRINELL_HISTORY_MAX_PRESSURE, &pressures.data, &pressures.n), "history");
    for (double p : pressures) figures.largest_pressure = std::max(figures.largest_pressure, p);
    brinell_state state{};
    state.size = sizeof state;
    check(brinell_results_state(results.get(), figures.n_states - 1, &state), "state");
    figures.dent = state.residual_depth;
    Span u;
    check(brinell_results_field(results.get(), figures.n_states - 1, BRINELL_FIELD_DISPLACEMENT, &u.data, &u.n), "field");
    for (double v : u) figures.displacement += v * v;
    return figures;
}

template <class T> T sized() {
    T value{};
    value.size = sizeof value;
    return value;
}

void blocks() {
    constexpr int nx = 4, ny = 2, row = nx + 1, each = row * (ny + 1);
    auto node = [](int body, int i, int j) -> int64_t { return body * each + j * row + i; };
    brinell_model *out = nullptr;
    check(brinell_model_new(BRINELL_PLANE_STRAIN, 2, &out), "model");
    Model model(out);
    std::vector<int64_t> middle, rows[4];
    std::vector<double> gaps;
    for (int body = 0; body < 2; ++body) {
        const char *name = body == 0 ? "lower" : "upper";
        std::vector<double> coordinates;
        std::vector<int64_t> elements;
        for (int j = 0; j <= ny; ++j)
            for (int i = 0; i <= nx; ++i) coordinates.insert(coordinates.end(), {0.5 * i, body + 0.5 * j});
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i)
                elements.insert(elements.end(),
                                {node(body, i, j), node(body, i + 1, j), node(body, i + 1, j + 1), node(body, i, j + 1)});
        for (int j = 0; j <= ny; ++j) middle.push_back(node(body, 0, j));
        check(brinell_model_nodes(model.get(), coordinates.data(), each), "nodes");
        check(brinell_model_elements(model.get(), name, BRINELL_SHAPE_QUAD4, elements.data(), nx * ny), "elements");
    }
    for (int i = 0; i <= nx; ++i) {
        rows[0].push_back(node(0, i, 0));
        rows[1].push_back(node(0, i, ny));
        rows[2].push_back(node(1, i, 0));
        rows[3].push_back(node(1, i, ny));
        gaps.push_back(0.002 * (0.5 * i) * (0.5 * i));
    }
    const char *surfaces[] = {"floor", "face", "opposite", "top"};
    for (int k = 0; k < 4; ++k)
        check(brinell_model_surface_of_nodes(model.get(), surfaces[k], rows[k].data(), row), "surface");
    check(brinell_model_node_set(model.get(), "middle", middle.data(), middle.size()), "node set");
    // Arrays for the mesh and the pairs, scene text for all else.
    check(brinell_model_contact_pairs(model.get(), "first = 'opposite'\nsecond = 'face'", row, rows[2].data(),
                                      rows[1].data(), nullptr, gaps.data()),
          "contact");
    check(brinell_model_tables(model.get(), R"(
bodies = { lower = { material = 'steel' }, upper = { material = 'steel' } }
support = [{ on = 'floor', fix = ['y'] }, { on = 'middle', fix = ['x'] }]
load = [{ on = 'top', pressure = 300 }]
program.targets = [{ load_factor = 1.0 }, { load_factor = 0.0 }]
[materials.steel]
youngs_modulus = 210e3
poissons_ratio = 0.3
yield_stress = 300
plastic_modulus = 2100
)"),
          "tables");
    brinell_results *run = nullptr;
    check(brinell_model_run(model.get(), nullptr, nullptr, nullptr, &run), "run");
    Results results(run);
    auto state = sized<brinell_state>();
    check(brinell_results_state(results.get(), 0, &state), "state");
    std::printf("blocks: contact force %.15e, largest pressure %.15e, points that flow %llu\n", state.contact_force,
                state.max_pressure, static_cast<unsigned long long>(state.plastic_points));
    Span left;
    check(brinell_results_pairs(results.get(), 1, BRINELL_PAIR_GAP, &left.data, &left.n), "gaps");
    std::printf("gaps left:");
    for (double gap : left) std::printf(" %.15e", gap);
    std::printf("\n");
}

void springs() {
    const int64_t column_starts[] = {0, 1, 3, 5}, rows[] = {0, 0, 1, 1, 2};
    const double values[] = {2, -1, 2, -1, 1};
    const int64_t row_starts[] = {0, 1}, freedoms[] = {2};
    const double coefficients[] = {1}, gaps[] = {1}, rate[] = {0, 0, 1};
    brinell_matrix matrix = {sizeof matrix, 3, column_starts, rows, values, BRINELL_TRIANGLE_UPPER};
    brinell_rows contact = {sizeof contact, 1, row_starts, freedoms, coefficients, gaps};
    brinell_structure *out = nullptr;
    check(brinell_structure_new(&matrix, &contact, nullptr, &out), "structure");
    Structure structure(out);
    Span data;
    check(brinell_structure_condensed(structure.get(), &data.data, &data.n), "condensed");
    std::printf("condensed stiffness %zu x %zu: %.15e\n", data.n, data.n, data.data[0]);
    double t = 0, u[3];
    size_t changes = 0, row = 0;
    int32_t closes = 0, closed = 0;
    check(brinell_structure_start(structure.get(), rate, 3), "start");
    check(brinell_structure_step(structure.get(), 2.0, &t, &changes), "step");
    check(brinell_structure_change(structure.get(), 0, &row, &closes), "change");
    std::printf("row %zu %s at t = %.15e\n", row, closes ? "closes" : "opens", t);
    check(brinell_structure_step(structure.get(), 2.0, &t, &changes), "step");
    check(brinell_structure_forces(structure.get(), &data.data, &data.n), "forces");
    std::printf("force at t = %.15e: %.15e\n", t, data.data[0]);
    check(brinell_structure_displacements(structure.get(), u, 3, nullptr), "displacements");
    check(brinell_structure_statuses(structure.get(), &closed, 1), "statuses");
    std::printf("displacements %.15e %.15e %.15e, closed %d\n", u[0], u[1], u[2], closed);
}

}  // namespace

int main(int argc, char **argv) try {
    if (argc != 2) return 2;
    Figures figures[2];
    std::thread other([&] { figures[1] = analyse(argv[1]); });
    figures[0] = analyse(argv[1]);
    other.join();
    for (const Figures &f : figures)
        std::printf("increments %zu, states %zu, yield load %.15e, largest pressure %.15e, dent %.15e, displacement %.15e\n",
                    f.increments, f.n_states, f.yield_load, f.largest_pressure, f.dent, f.displacement);
    Scene scene = load(argv[1]);
    brinell_results *out = nullptr;
    auto stop = [](const brinell_increment *increment, void *) -> int32_t { return increment->number >= 3; };
    int status = brinell_run(scene.get(), nullptr, stop, nullptr, &out);
    Results results(out);
    Span alpha;
    check(brinell_results_history(results.get(), BRINELL_HISTORY_ALPHA, &alpha.data, &alpha.n), "history");
    std::printf("stopped with status %d after %zu increments\n", status, alpha.n);
    brinell_scene *none = nullptr;
    status = brinell_scene_parse("kind = 3", &none);
    std::printf("refused with status %d: %s\n", status, brinell_last_error());
    blocks();
    springs();
    return 0;
} catch (const std::exception &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
