#!/usr/bin/env python3
"""Applies 66 seeded faults to a checkout of brinell: faults.py CHECKOUT [--check] [--tsv FILE]

With --check only whether each fault still finds its line.

Fault n is wrong only where BRINELL_MUTANT=n; without it the code does what it did.
"""
import shutil
import subprocess
import sys
from pathlib import Path

ON = "crate::mutants::on(%d)"


def x(n, wrong, right):
    return "(if crate::mutants::on(%d) { %s } else { %s })" % (n, wrong, right)


def on(n):
    return ON % n


# number, file, snippet, replacement, floor, what, suites, subtle
F = []


def f(n, path, old, new, floor, what, suites):
    F.append((n, path, old, new, floor, what, suites))


f(1, "shape/cut.rs", "if squared(k) < squared(best) { k } else { best }",
  "if " + x(1, "squared(k) > squared(best)", "squared(k) < squared(best)") + " { k } else { best }",
  "shape", "a subdivided tetrahedron is cut along the longest instead of the shortest inner diagonal",
  "unit mesh::subdivision, unit shape; solid")
f(2, "element/gradients.rs", "factors: radius.map(|r| (r / of_center).sqrt()),",
  "factors: radius.map(|r| " + x(2, "r / of_center", "(r / of_center).sqrt()") + "),",
  "element", "shear of the axisymmetric bilinear element is scaled by r/r_c instead of its square root",
  "unit element; verification, accuracy")
f(3, "element/mod.rs", "if let Some(mean) = &self.mean {",
  "if let Some(mean) = self.mean.as_ref().filter(|_| !" + on(3) + ") {",
  "element", "strains at the sampling points (first yield) keep the local dilatation instead of the mean (B-bar)",
  "unit element; verification (yield_load), accuracy")
f(4, "material/radial_return.rs", "if i < 3 { 1.0 } else { 2.0 };",
  x(4, "if i < 3 || i == 5 { 1.0 } else { 2.0 }", "if i < 3 { 1.0 } else { 2.0 }") + ";",
  "material", "plastic shear strain zx (space only) lacks the factor 2 of engineering strain",
  "unit material (solid), solid, verification, invariance (mirrors)")
f(5, "material/plane_stress.rs", "(start[j] + forgotten[j]) / b[j]",
  "(start[j] + " + x(5, "-forgotten[j]", "forgotten[j]") + ") / b[j]",
  "material", "plane stress: the part of fading back stresses that is forgotten has the wrong sign",
  "unit material (fading); verification (back_stresses, cyclic_element)")
f(6, "accuracy/effort.rs", "FACTORISATION[usize::from(kind.is_solid())]",
  "FACTORISATION[usize::from(kind.is_solid() && !" + on(6) + ")]",
  "accuracy", "the time a next mesh of a solid would take is predicted with the power of plane models (budget)",
  "unit accuracy::effort; accuracy (demand, solid)")
f(7, "material/hardening.rs", "0.5 * (start[1] + self.yield_stress(end)) * (end - start[0])",
  x(7, "start[1] * (end - start[0])", "0.5 * (start[1] + self.yield_stress(end)) * (end - start[0])"),
  "material", "plastic work takes the yield stress at the start of a segment of the curve, not its mean",
  "unit material; verification, output")
f(8, "mesh/gmsh/assemble.rs", "2 => at == 0,", "2 => at == " + "usize::from(" + on(8) + "),",
  "mesh", "a curve of Gmsh between two bodies of one mesh becomes the facet of the body on its other side",
  "unit mesh::gmsh; stability")
f(9, "mesh/sweep.rs", "outward: x > 0.0,", "outward: " + x(9, "x < 0.0", "x > 0.0") + ",",
  "mesh", "a straight edge revolved to a cylinder is taken as hollow instead of round and vice versa",
  "unit mesh::sweep; solid (swept)")
f(10, "mesh/subdivision.rs", "new.x = along(new.mapped, 1.0, moved);",
  "new.x = along(new.mapped, " + x(10, "-1.0", "1.0") + ", moved);",
  "mesh", "inner nodes of subdivided linear elements move away from curved sides instead of along with them",
  "unit mesh::subdivision; stability (refinement), solid")
f(11, "mesh/validate.rs", "if worst > FLATTEST {",
  "if worst > " + x(11, "1e-3 * FLATTEST", "FLATTEST") + " {",
  "mesh", "elements a thousand times flatter than allowed pass the check of the mesh",
  "unit mesh::validate; fuzz, cli (mutations)")
f(12, "mesh/generate/contact_size.rs", "(2.0 / extrude.depth, size * extrude.depth)",
  "(" + x(12, "1.0 / extrude.depth", "2.0 / extrude.depth") + ", size * extrude.depth)",
  "mesh", "for an extruded half model the load that sizes the fine mesh lacks the factor 2 of symmetry",
  "unit mesh::generate; solid (extruded), stability (outgrown)")
f(13, "mesh/conformity.rs", "if !same_side && m == n {",
  "if !same_side && " + x(13, "m.len() == n.len()", "m == n") + " {",
  "mesh", "neighbours that share an edge but have different mid-side nodes there pass as conforming",
  "unit mesh::validate, unit mesh::gmsh; cli (mutations)")
f(14, "scene/catalogue.rs", "tangent_modulus: self.tangent_modulus.as_ref().map(in_units),",
  "tangent_modulus: self.tangent_modulus.as_ref().map(|t| " + x(14, "t.0", "in_units(t)") + "),",
  "scene", "the tangent modulus of a listed material stays in MPa whatever the units of the scene",
  "unit scene::catalogue; invariance (units)")
f(15, "scene/validate/material.rs", "nu > -1.0 && nu < 0.5,",
  "nu > -1.0 && " + x(15, "nu <= 0.5", "nu < 0.5") + ",",
  "scene", "Poisson's ratio 0.5 itself is accepted",
  "unit scene::validate; cli (refusals), fuzz")
f(16, "scene/overrides.rs", "(DeValue::Table(table), DeValue::Table(given)) => {",
  "(DeValue::Table(table), DeValue::Table(given)) if !" + on(16) + " => {",
  "scene", "--set of an inline table replaces the table there instead of changing the keys given",
  "unit scene::read (overrides); cli")
f(17, "error.rs", "ErrorKind::Outgrown => 8,", "ErrorKind::Outgrown => " + x(17, "7", "8") + ",",
  "cli", "exit code and status of a contact that outgrows its candidates is that of an inaccurate run",
  "unit error; stability (outgrown)")
f(18, "deck/history.rs", "false => at - time.start,",
  "false => at - " + x(18, "0.0", "time.start") + ",",
  "deck", "an amplitude over step time is read at total time: wrong from the second step on",
  "unit deck; decks (calculix, converted)")
f(19, "deck/series.rs", "if v.abs() > m.abs() { v } else { m }",
  "if " + x(19, "v >= m.abs()", "v.abs() > m.abs()") + " { v } else { m }",
  "deck", "the largest value of a history is sought without its sign: wholly negative loads count as none",
  "unit deck::series; decks")
f(20, "deck/conversion/conditions.rs", "sum.series.add(&entry.series, share);",
  "sum.series.add(&entry.series, " + x(20, "axes[&node][global][axis as usize]", "share") + ");",
  "deck", "forces at nodes with *TRANSFORM are turned the wrong way round (transposed axes)",
  "decks (tilted_block, calculix), unit deck")
f(21, "deck/conversion/held_planes.rs", "total: sum.largest() / draft.thickness,",
  "total: sum.largest() / " + x(21, "1.0", "draft.thickness") + ",",
  "deck", "the force on a side held plane is not divided by the thickness of a plane model",
  "decks (held_plane, converted)")
f(22, "model/loads.rs", ".map(|&i| (i, share.map(|f| f / n)))",
  ".map(|&i| (i, " + x(22, "force", "share") + ".map(|f| f / n)))",
  "model", "a force on a node set is not divided by the copies of a symmetric model",
  "unit model; verification, invariance (loads, mirrors)")
f(23, "model/initial_strain.rs", "false => -stress[k] / material.shear_modulus(),",
  "false => -stress[k] / (" + x(23, "2.0", "1.0") + " * material.shear_modulus()),",
  "model", "the shear strain of an initial stress is half of what it should be",
  "unit model::initial_strain; verification (initial_state)")
f(24, "model/equations.rs", "let share = -term.coefficient / first.coefficient;",
  "let share = " + x(24, "-term.coefficient * first.coefficient", "-term.coefficient / first.coefficient") + ";",
  "model", "terms of an equation are multiplied by the first coefficient instead of divided by it",
  "verification (equations), decks (lever)")
f(25, "model/depth.rs", "(dot(off, way) / square).clamp(0.0, 1.0)",
  "(dot(off, way) / square).clamp(0.0, " + x(25, "f64::INFINITY", "1.0") + ")",
  "model", "depth below a surface is measured from the line through a facet, beyond its second end too",
  "unit model::depth; verification (yield_depth, initial_state)")
f(26, "model/pairs/mortar/dual.rs", "out[(k + 1) % n] += ALPHA * middle;",
  "out[" + x(26, "(k + n - 1) % n", "(k + 1) % n") + "] += ALPHA * middle;",
  "model", "the dual basis of quadratic faces hands the share of a mid-side node to a wrong corner",
  "mortar (patch, conforming, hertz_in_space), solid")
f(27, "model/heat.rs", "if !mesh.shapes[element].is_quadratic() {",
  "if !mesh.shapes[element].is_quadratic() || " + on(27) + " {",
  "model", "temperatures that vary are averaged over quadratic elements too",
  "verification (heat), decks (gradient, heat)")
f(28, "model/pairs/mortar.rs", ".filter(|pair| pair.gap.abs() > most)",
  ".filter(|pair| " + x(28, "pair.gap", "pair.gap.abs()") + " > most)",
  "model", "a tie of surfaces that overlap by more than allowed is not refused",
  "mortar (tie), decks (tied, refusals), unit model")
f(29, "assembly/mod.rs", "for (place, &e) in elements.iter().enumerate() {",
  "for (place, &e) in elements.iter().enumerate().take(elements.len().saturating_sub(usize::from(" + on(29) + "))) {",
  "assembly", "the last element with prescribed displacements gives no load",
  "unit assembly; stability (prescribed), verification")
f(30, "linalg/row_sums.rs", "rows.terms[row] += terms;",
  "rows.terms[row] += " + x(30, "0.0", "terms") + ";",
  "linalg", "the size of the terms of a row misses what other parts of the matrix hold (componentwise error)",
  "unit linalg (accuracy); stability (quality)")
f(31, "linalg/refinement.rs", "(-a).mul_add(b, -product)",
  x(31, "0.0", "(-a).mul_add(b, -product)"),
  "linalg", "the twofold residual loses the round-off of its products",
  "unit linalg (accuracy), unit constrained")
f(32, "linalg/faer/factor.rs", "if i == j { diagonal[j] } else { values[entry] }",
  "if i == j && !" + on(32) + " { diagonal[j] } else { values[entry] }",
  "linalg", "faer: the shift that holds floating bodies is not on the diagonal that is factored",
  "unit linalg::faer; backends, stability with faer")
f(33, "linalg/cholmod/factor.rs", "self.permutation().get(minor).copied().unwrap_or(0) as usize",
  x(33, "minor", "self.permutation().get(minor).copied().unwrap_or(0) as usize"),
  "linalg", "CHOLMOD: the freedom that is not held is named by its place in the order of elimination",
  "unit linalg (refusals); cli (refusals), stability")
f(34, "substructure/rows.rs", "if row[1].0 == *follow { 1.0 } else { -1.0 }",
  "if row[1].0 == *follow || " + on(34) + " { 1.0 } else { -1.0 }",
  "substructure", "where the stiffer body's node leads a pair, the slip has the wrong sign",
  "unit substructure; stability (numbers), selftest, verification")
f(35, "contact/path.rs",
  "let n = tableau.len();\n        let (zero_gap, zero_force) = self.zero(tableau, 1.0);",
  "let n = tableau.len();\n        let (zero_gap, zero_force) = self.zero(tableau, " + x(35, "1e3", "1.0") + ");",
  "contact", "pairs count as at their border within a tolerance a thousand times too large",
  "unit contact; properties (path)")
f(36, "contact/path.rs", "LAST * value\n", x(36, "end_force", "LAST * value") + "\n",
  "contact", "the last pair that holds a body may open at the end of an unloading to nothing",
  "stability (held_by_contact, receding), unit contact; selftest")
f(37, "contact/tableau.rs", "left <= round_off.max(SINGULAR * whole)",
  "left <= round_off.max(" + x(37, "1e3 * SINGULAR", "SINGULAR") + " * whole)",
  "contact", "a body counts as free when a pair opens with a tolerance a thousand times too large",
  "unit contact; properties (complementarity), stability (numbers)")
f(38, "contact/loose.rs", "None => return Ok(complement(&held)),",
  "None if " + on(38) + " => return Ok(DMatrix::zeros(held.nrows(), 0)),\n                "
  "None => return Ok(complement(&held)),",
  "contact", "no spring keeps a motion that nothing holds and no load drives",
  "unit contact::loose; stability (loose_sideways, held_by_contact)")
f(39, "constrained/displacements.rs", "(&self.gaps - &self.rows * here)",
  "(&self.gaps * " + x(39, "0.0", "1.0") + " - &self.rows * here)",
  "constrained", "refined displacements close rows as if their gaps were zero",
  "unit constrained; backends, capi")
f(40, "analysis/increments/elastic.rs", "let t = before + share * (self.path.t() - before);",
  "let t = " + x(40, "share * self.path.t()", "before + share * (self.path.t() - before)") + ";",
  "analysis", "the load of first yield is interpolated from the start of the stretch, not from the last event",
  "verification (yield_load, hertz_line, run), unit analysis")
f(41, "model/symmetry.rs",
  "let is_loaded = |other: &MirrorSide| other.nodes.iter().all(|&n| conditions.loaded[n]);",
  "let is_loaded = |other: &MirrorSide| {\n    let mut loads = other.nodes.iter().map(|&n| conditions.loaded[n]);\n"
  "    if " + on(41) + " { loads.any(|l| l) } else { loads.all(|l| l) }\n};",
  "analysis", "a plane counts as one of symmetry although a single node at its rim is pushed along it",
  "unit model::symmetry; stability (whether_it_yields)")
f(42, "analysis/increments/landing.rs", "let accuracy = RootTolerance::both(MONITOR_ACCURACY);",
  "let accuracy = RootTolerance::both(" + x(42, "1e3 * MONITOR_ACCURACY", "MONITOR_ACCURACY") + ");",
  "analysis", "landing on a target (half width, displacement) in plastic steps is a thousand times less accurate",
  "verification (run), properties (steps), stability (numbers), unit analysis")
f(43, "analysis/increments/plastic.rs", "rules.program.steps.saturating_sub(self.taken)",
  "rules.program.steps.saturating_sub(self.taken + usize::from(" + on(43) + "))",
  "analysis", "a program of n equal steps takes n-1",
  "properties (steps), cost (counts), verification (cycles)")
f(44, "analysis/increments/step_length.rs", "share(k) <= smallest * (1.0 + TIE)",
  "share(k) <= smallest * (1.0 + " + x(44, "1e3 * TIE", "TIE") + ")",
  "analysis", "changes of contact within 1e-4 instead of 1e-7 of a step count as one event",
  "unit analysis::increments::step_length; properties (steps), invariance (numbering)")
f(45, "analysis/increments/collapse.rs", "if left <= LOST && attempt.round_off <= LOST {",
  "if " + x(45, "left <= LOST || attempt.round_off <= LOST", "left <= LOST && attempt.round_off <= LOST") + " {",
  "analysis", "every increment that does not converge is reported as a limit load",
  "stability (collapse, numbers), cli")
f(46, "analysis/figures/dent.rs", "0 => [-slave, faced],", "0 => " + x(46, "[faced, -slave]", "[-slave, faced]") + ",",
  "analysis", "the dent's shares of the two bodies are exchanged, with wrong signs, where the first surface is the slave",
  "invariance (dent), mortar, selftest")
f(47, "analysis/figures/contact_patch.rs",
  "let bracket = [distance - 0.5 * spacing, distance + spacing];",
  "let bracket = [distance - 0.5 * spacing, distance + " + x(47, "0.5", "1.0") + " * spacing];",
  "analysis", "the edge of contact is never sought in the outer half of the element that it ends in",
  "verification (hertz_line, hertz_point, hertz_line_history), unit analysis")
f(48, "analysis/figures/contact_area/readings.rs", "stays.filter(|off| *off <= near).count() as f64",
  x(48, "1.0", "stays.filter(|off| *off <= near).count() as f64"),
  "analysis", "areas of pairs on planes of symmetry are not doubled when a patch in space is read",
  "solid (patches, hertz), unit analysis::figures::contact_area")
f(49, "analysis/figures/reactions.rs", "forces[node] = along(forces[node], -force, axis);",
  "forces[node] = along(forces[node], " + x(49, "0.0", "-force") + ", axis);",
  "analysis", "forces of nodes that follow others (ties, equations) are handed on but not taken off there",
  "mortar (tied_bodies), verification (equations), output (fields)")
f(50, "analysis/program/cycles.rs", "0.5 * square(shear)", x(50, "1.0", "0.5") + " * square(shear)",
  "analysis", "growth and flow per cycle count engineering shear strains twice",
  "stability (cycles), verification (cycles, shakedown)")
f(51, "analysis/program/checkpoints.rs", "(first + 1..=end).contains(&point.increment)",
  "(first + usize::from(!" + on(51) + ")..=end).contains(&point.increment)",
  "analysis", "after --resume a point of the path at the end of a stored part is there twice",
  "stability (checkpoint, killed), cli")
f(52, "analysis/choice/zone_choice.rs", ".map(|&e| !core[e])",
  ".map(|&e| !core[e] && !" + on(52) + ")",
  "analysis", "no element of the plastic zone is a guard: the zone is not made larger when its rim yields",
  "unit analysis::choice::zone_choice; cost (counts)")
f(53, "analysis/figures/measure.rs", "sum * model.symmetry",
  "sum * " + x(53, "1.0", "model.symmetry"),
  "analysis", "the load of a run that a gap drives is that of the meshed part, not of all its copies",
  "verification (gap_load), invariance (loads, mirrors), stability (prescribed)")
f(54, "analysis/zone/points.rs", "self.back.put(points, &history.back, from);",
  "if !" + on(54) + " {\n            self.back.put(points, &history.back, from);\n        }",
  "analysis", "going back to an earlier state leaves the strains of fading back stresses as they are",
  "verification (back_stresses, cyclic_element), stability (checkpoint, cycles)")
f(55, "analysis/figures/at_target.rs",
  "plastic_work: plastic_work * self.solver.structure.model.symmetry,",
  "plastic_work: plastic_work * " + x(55, "1.0", "self.solver.structure.model.symmetry") + ",",
  "analysis", "the plastic work reported is that of the meshed part, not of all its copies",
  "invariance (mirrors), verification, output (summary)")
f(56, "checkpoint/identity.rs", "if self.start != now.start {",
  "if self.start != now.start && !" + on(56) + " {",
  "checkpoint", "a run is resumed although the state that it started from has changed",
  "unit checkpoint::identity; stability (checkpoint), verification (start_from)")
f(57, "checkpoint/store.rs", "if (length, hash) != (id.length, id.hash) {",
  "if (length, " + x(57, "id.hash", "hash") + ") != (id.length, id.hash) {",
  "checkpoint", "a part of a checkpoint that belongs to another run is taken if it has the same length",
  "stability (checkpoint, killed), unit checkpoint")
f(58, "accuracy/extrapolation.rs", "(n as f64 * square / (n - constants) as f64).sqrt()",
  x(58, "square.sqrt()", "(n as f64 * square / (n - constants) as f64).sqrt()"),
  "accuracy", "the scatter of an extrapolation is not corrected for the constants fitted",
  "unit accuracy::extrapolation; accuracy (claims, estimate)")
f(59, "accuracy/outcome.rs", "relative / wanted > excess {",
  x(59, "relative > out.stated", "relative / wanted > excess") + " {",
  "accuracy", "with several demands the largest error is called the worst, not that farthest beyond its demand",
  "unit accuracy::outcome; accuracy (demand)")
f(60, "output/vtu.rs", "let rows = [xx, xy, zx, xy, yy, yz, zx, yz, zz];",
  "let rows = " + x(60, "[xx, xy, yz, xy, yy, zx, yz, zx, zz]", "[xx, xy, zx, xy, yy, yz, zx, yz, zz]") + ";",
  "output", "stress tensors of solids have xz and yz exchanged in the VTU files",
  "output (vtu, fields, python), solid")
f(61, "output/contact.rs", "z: (dimension == 3).then_some(pair.position[2]),",
  "z: (dimension == 3).then_some(pair.position[" + x(61, "1", "2") + "]),",
  "output", "the column z of contact.csv of a solid holds y",
  "output (tables), solid, cli (solids)")
f(62, "output/report/tables.rs", "100.0 * (ratio - 1.0)",
  "100.0 * " + x(62, "1.0 - 1.0 / ratio", "(ratio - 1.0)"),
  "output", "the difference to a reference value in the report is in percent of what was computed",
  "output (report), unit output::report")
f(63, "results/quality.rs", ".filter(|(_, value, most)| value.is_nan() || value > most)",
  ".filter(|(_, value, most)| (value.is_nan() && !" + on(63) + ") || value > most)",
  "results", "a figure of quality that is not a number misses no tolerance",
  "unit analysis::figures::quality, unit results; stability (quality)")
f(64, "cli/sweep/arguments.rs", "common.overrides.iter().cloned().chain(of_point).collect()",
  "if " + on(64) + " {\n        return of_point.chain(common.overrides.iter().cloned()).collect();\n    }\n    "
  "common.overrides.iter().cloned().chain(of_point).collect()",
  "cli", "in a sweep --set of the same key wins over --vary",
  "cli (sweep)")
f(65, "capi/border.rs", "Ok(size.min(size_of::<T>()))",
  "Ok(" + x(65, "size.min(size_of::<T>()).saturating_sub(8).max(size_of::<usize>())",
            "size.min(size_of::<T>())") + ")",
  "capi", "the last eight bytes of each struct are neither read nor written",
  "unit capi; capi (header, python)")
f(66, "selftest/cases.rs", "if figure.is_nan() || figure.abs() > self.worst {",
  "if (figure.is_nan() && !" + on(66) + ") || figure.abs() > self.worst {",
  "selftest", "a figure that is not a number counts as passed",
  "stability (selftest), unit selftest")

MUTANTS = '''//! Seeded faults that measure the tests: number n is switched on by `BRINELL_MUTANT=n`.

use std::sync::OnceLock;

static CHOSEN: OnceLock<u32> = OnceLock::new();

/// Whether fault `n` is switched on.
#[inline]
pub fn on(n: u32) -> bool {
    *CHOSEN.get_or_init(chosen) == n
}

#[cold]
fn chosen() -> u32 {
    let text = std::env::var("BRINELL_MUTANT").unwrap_or_default();
    match text.trim() {
        "" => 0,
        number => number.parse().expect("BRINELL_MUTANT is a number"),
    }
}
'''


def main():
    checkout = Path(sys.argv[1])
    src = checkout / "src"
    if (src / "mutants.rs").exists():
        sys.exit(f"{src}/mutants.rs is there already: the faults have been applied")
    assert [fault[0] for fault in F] == list(range(1, 67)), "66 numbers in order"
    texts, wrong = {}, []
    for n, path, old, *_ in F:
        file = src / path
        texts.setdefault(path, file.read_text() if file.exists() else "")
        count = texts[path].count(old)
        if count != 1:
            wrong.append(f"fault {n}: src/{path} has the snippet {count} times: {old!r}")
    lib = (src / "lib.rs").read_text()
    first = "mod text;\n"
    if lib.count("\n" + first) != 1:
        wrong.append("src/lib.rs: `mod text;` is not there exactly once")
    if wrong:
        sys.exit("\n".join(wrong))
    if "--check" in sys.argv:
        return
    rows, changed = [], dict(texts)
    for n, path, old, new, floor, what, suites in F:
        line = texts[path][: texts[path].index(old)].count("\n") + 1
        # Of a snippet of several lines, that of the last is the changed one.
        line += old.rstrip("\n").count("\n")
        rows.append((n, f"src/{path}:{line}", floor, what, suites))
        if changed[path].count(old) != 1:
            sys.exit(f"fault {n}: another fault has changed its snippet in src/{path}")
        changed[path] = changed[path].replace(old, new)
        if f"crate::mutants::on({n})" not in changed[path]:
            sys.exit(f"fault {n} does not ask whether it is on")
    for path, text in changed.items():
        (src / path).write_text(text)
    (src / "mutants.rs").write_text(MUTANTS)
    lib = lib.replace("\n" + first, "\n#[doc(hidden)]\npub mod mutants;\n\n" + first)
    lib = lib.replace("#![warn(missing_docs)]\n", "#![warn(missing_docs)]\n#![allow(unused_parens)]\n", 1)
    (src / "lib.rs").write_text(lib)
    # The tests hold lines to 100 columns.
    if shutil.which("rustfmt"):
        files = [str(src / path) for path in [*changed, "mutants.rs"]]
        subprocess.run(["rustfmt", "--edition", "2024", *files], check=True)
    if "--tsv" in sys.argv:
        out = Path(sys.argv[sys.argv.index("--tsv") + 1])
        head = "number\tfile:line\tfloor\twhat is wrong\texpected to be caught by\n"
        out.write_text(head + "".join("\t".join(map(str, row)) + "\n" for row in rows))
    print(f"{len(F)} faults in {len(changed)} files")


main()
