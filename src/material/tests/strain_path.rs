//! Strain path of an increment, compared with very small steps.

use super::*;

impl<const S: usize> Point<S> {
    /// Moves the point along the straight path from one total strain to another.
    fn follow(&mut self, m: &Material, path: [&[f64; S]; 2]) -> Update<S> {
        let (mut strains, mut between) = (self.back.clone(), self.back.clone());
        let mut memory = Memory {
            strains: &mut strains,
            between: &mut between,
            lost_work: 0.0,
        };
        let path = (Some(path[0]), path[1]);
        let update = m.integrate_along(&m.lame(), path, &self.past(), &mut memory);
        if update.yields {
            self.lost_work += memory.lost_work;
            self.back = strains;
        }
        self.state = update.state;
        update
    }
}

fn between<const S: usize>([begin, end]: [&[f64; S]; 2], share: f64) -> [f64; S] {
    std::array::from_fn(|k| begin[k] + share * (end[k] - begin[k]))
}

/// Pseudo-random number between -1 and 1.
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
    2.0 * ((*seed >> 11) as f64 / (1u64 << 53) as f64) - 1.0
}

fn distance<const S: usize>(a: &[f64; S], b: &[f64; S]) -> f64 {
    let difference: [f64; S] = std::array::from_fn(|k| a[k] - b[k]);
    von_mises(&difference)
}

/// A point that was brought beyond yield, its strain, and a strain at the distance `size` from it.
fn turned<const S: usize>(m: &Material, size: f64, seed: &mut u64) -> (Point<S>, [[f64; S]; 2]) {
    let mut strain = || -> [f64; S] {
        std::array::from_fn(|k| match (m.space, k) {
            (Space::PlaneStress, 2) => 0.0,
            _ => random(seed),
        })
    };
    let (first, change) = (strain().map(|e| 0.01 * e), strain());
    let mut point = Point::new(m);
    for i in 1..=20 {
        point.advance(m, &first.map(|e| e * f64::from(i) / 20.0));
    }
    let end = std::array::from_fn(|k| first[k] + size * change[k]);
    (point, [first, end])
}

/// Point after `n` small steps of the implicit rule.
fn in_steps<const S: usize>(
    point: &Point<S>,
    m: &Material,
    [begin, end]: [&[f64; S]; 2],
    n: i32,
) -> Point<S> {
    let mut point = point.clone();
    for i in 1..=n {
        point.advance(m, &between([begin, end], f64::from(i) / f64::from(n)));
    }
    point
}

/// Point after `n` paths, one after the other.
fn in_paths<const S: usize>(
    point: &Point<S>,
    m: &Material,
    path: [&[f64; S]; 2],
    n: i32,
) -> Point<S> {
    let mut point = point.clone();
    let at = |i: i32| between(path, f64::from(i) / f64::from(n));
    for i in 0..n {
        point.follow(m, [&at(i), &at(i + 1)]);
    }
    point
}

/// Mean errors of the stress, relative to the yield stress, of the implicit rule in one step and of
/// one, two and four paths; and the same errors of the work that back stresses lose, relative to
/// that work.
fn errors<const S: usize>(space: Space, size: f64) -> ([f64; 4], [f64; 4]) {
    let mut seed = 5;
    let (mut stress, mut work, mut count) = ([0.0f64; 4], [0.0f64; 4], 0.0);
    for curve in curves() {
        for m in each_kind(material(space, 0.3, curve)) {
            for _ in 0..2 {
                let (point, [begin, end]) = turned::<S>(&m, size, &mut seed);
                let path = [&begin, &end];
                let of = |p: &Point<S>| {
                    let lost = p.lost_work - point.lost_work;
                    (m.lame().stress(&end, &p.state.strain), lost)
                };
                let [(coarse, lost_coarse), (fine, lost_fine)] =
                    [400, 800].map(|n| of(&in_steps(&point, &m, path, n)));
                let exact: [f64; S] = std::array::from_fn(|k| 2.0 * fine[k] - coarse[k]);
                let lost = 2.0 * lost_fine - lost_coarse;
                let mut whole = point.clone();
                whole.advance(&m, &end);
                let [one, two, four] = [1, 2, 4].map(|n| in_paths(&point, &m, path, n));
                for (i, found) in [whole, one, two, four].iter().enumerate() {
                    let (found, found_lost) = of(found);
                    stress[i] += distance(&found, &exact);
                    work[i] += (found_lost - lost).abs();
                }
                count += lost.abs();
            }
        }
    }
    (stress.map(|sum| sum / 18.0), work.map(|sum| sum / count))
}

/// Paths of a tenth, a half, twice and ten times the strain at yield, in any direction, have at
/// most a tenth of the error of the implicit rule. Second order leaves a sixteenth of the error to
/// quarter paths; only a seventh is required, as tables of hardening have kinks and ten times is
/// far from small.
#[test]
fn a_path_is_followed_however_flow_turns_on_it() {
    for size in [5e-4, 2.5e-3, 1e-2, 5e-2] {
        for (stress, work) in [
            errors::<6>(Space::Solid, size),
            errors::<4>(Space::PlaneStrain, size),
        ] {
            for [whole, one, two, four] in [stress, work] {
                let all = format!("{size}: {stress:?} {work:?}");
                assert!(one < 0.1 * whole, "{all}");
                assert!(two < one / 2.0 && four < one / 7.0, "{all}");
            }
        }
    }
}

/// If flow does not turn, the implicit rule is exact, and the path gives the same up to round-off.
#[test]
fn a_path_in_one_direction_is_that_of_the_implicit_rule() {
    for curve in curves() {
        for m in each_kind(material(Space::Solid, 0.3, curve)) {
            let strain = [0.01, -0.004, -0.006, 0.002, 0.003, -0.001];
            let mut whole = Point::new(&m);
            whole.advance(&m, &strain);
            let mut path = Point::new(&m);
            path.follow(&m, [&[0.0; 6], &strain]);
            for (a, b) in whole.state.strain.iter().zip(&path.state.strain) {
                assert!((a - b).abs() < 1e-14, "{a} {b}");
            }
            let (a, b) = (whole.lost_work, path.lost_work);
            assert!((a - b).abs() <= 1e-12 * a, "{a} {b}");
        }
    }
}

/// The state at the end depends smoothly on the end of the path, so that iterations converge.
#[test]
fn the_end_of_a_path_moves_smoothly() {
    let mut seed = 11;
    for m in each_kind(material(Space::Solid, 0.3, Hardening::linear(1.0, 0.0))) {
        for _ in 0..40 {
            let (point, [begin, end]) = turned::<6>(&m, 4e-3, &mut seed);
            let stress_at = |share: f64| {
                let there = between([&begin, &end], share);
                let (mut strains, mut between) = (point.back.clone(), point.back.clone());
                let mut memory = Memory {
                    strains: &mut strains,
                    between: &mut between,
                    lost_work: 0.0,
                };
                let path = (Some(&begin), &there);
                let state = m
                    .integrate_along(&m.lame(), path, &point.past(), &mut memory)
                    .state;
                m.lame().stress(&there, &state.strain)
            };
            let ends: Vec<[f64; 6]> = (0..40)
                .map(|i| stress_at(1.0 - 1e-7 * f64::from(i)))
                .collect();
            let steps: Vec<f64> = ends
                .windows(2)
                .map(|pair| distance(&pair[0], &pair[1]))
                .collect();
            let largest = steps.iter().fold(0.0f64, |m, s| m.max(*s));
            // The stress changes by about E times the change of the strain. The error of the path,
            // 1e-3, causes no jump.
            assert!(largest < 1e-5, "{steps:?}");
        }
    }
}

/// The stress is also smooth where flow hardly turns, from no angle at all to one of a thousandth:
/// nowhere does the stress change by more than the change of strain requires. Iterations to 1e-10
/// could not get past a jump of 1e-9 of the yield stress.
#[test]
fn the_stress_does_not_jump_where_flow_begins_to_turn() {
    let mut seed = 5;
    for m in each_kind(material(Space::Solid, 0.3, Hardening::linear(1.0, 0.0))) {
        let (point, [begin, _]) = turned::<6>(&m, 0.0, &mut seed);
        let change: [f64; 6] = std::array::from_fn(|_| random(&mut seed));
        let stress_at = |angle: f64| {
            let there = std::array::from_fn(|k| 1.5 * begin[k] + 0.01 * angle * change[k]);
            let mut point = point.clone();
            let update = point.follow(&m, [&begin, &there]);
            m.lame().stress(&there, &update.state.strain)
        };
        let ratio: f64 = 1.02;
        let angles = (0..1500).map(|k| 1e-16 * ratio.powi(k));
        let mut before = (0.0, stress_at(0.0));
        for angle in angles.take_while(|angle| *angle < 1e-3) {
            let here = (angle, stress_at(angle));
            let strain = 0.01 * (here.0 - before.0) * von_mises(&change);
            let bound = 4.0 * m.youngs_modulus * strain + 1e-11;
            let jump = distance(&here.1, &before.1);
            assert!(jump <= bound, "{angle:e}: {jump:e} {bound:e}");
            before = here;
        }
    }
}

/// Mean errors, relative to the elastic stiffness, of the path's tangent and of the one-step
/// tangent, both compared with central differences of the stress at the end of the path. Paths go
/// on in the former direction except for a random part.
fn tangent_errors(size: f64, randomness: f64) -> [f64; 2] {
    let (mut seed, mut errors, mut count) = (7, [0.0; 2], 0.0);
    for curve in curves() {
        for mut m in each_kind(material(Space::Solid, 0.3, curve)) {
            if m.back_stresses.n_stored() > 0 {
                m.back_stresses = BackStresses::default();
            }
            let elastic = m.lame();
            for _ in 0..10 {
                let (point, [begin, aside]) = turned::<6>(&m, size, &mut seed);
                let end: [f64; 6] = std::array::from_fn(|k| {
                    begin[k] + size * 100.0 * begin[k] + randomness * (aside[k] - begin[k])
                });
                let follow = |end: &[f64; 6]| {
                    let mut point = point.clone();
                    let update = point.follow(&m, [&begin, end]);
                    (elastic.stress(end, &update.state.strain), update.softening)
                };
                let (direction, h): ([f64; 6], f64) =
                    (std::array::from_fn(|_| random(&mut seed)), 1e-6 * size);
                let [ahead, behind] =
                    [h, -h].map(|h| follow(&std::array::from_fn(|k| end[k] + h * direction[k])).0);
                let slope: [f64; 6] = std::array::from_fn(|k| (ahead[k] - behind[k]) / (2.0 * h));
                let whole = elastic.times(&direction);
                let tangents = [follow(&end).1, point.integrate(&m, &end).softening];
                for (error, tangent) in errors.iter_mut().zip(&tangents) {
                    let lost = tangent.times(&direction);
                    let left: [f64; 6] = std::array::from_fn(|k| whole[k] - lost[k]);
                    *error += distance(&left, &slope);
                }
                count += von_mises(&whole);
            }
        }
    }
    errors.map(|error| error / count)
}

/// The path's tangent agrees with the path if flow turns little, and is closer to it than the
/// tangent of one step if flow turns in any direction.
#[test]
fn the_tangent_is_nearer_to_the_path_than_that_of_one_step() {
    for size in [1e-3, 5e-3, 2e-2] {
        let [own, one_step] = tangent_errors(size, 0.1);
        let [turned, turned_one_step] = tangent_errors(size, 1.0);
        assert!(own < 0.1 * one_step, "{size}: {own} {one_step}");
        assert!(
            turned < 0.6 * turned_one_step,
            "{size}: {turned} {turned_one_step}"
        );
    }
}
