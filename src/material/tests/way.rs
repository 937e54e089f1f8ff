//! The way of an increment: against very small steps.

use super::*;

impl<const S: usize> Point<S> {
    /// Goes along the straight way from a total strain to another.
    fn follow(&mut self, m: &Material, way: [&[f64; S]; 2]) -> Update<S> {
        let (mut strains, mut between) = (self.back.clone(), self.back.clone());
        let mut memory = Memory {
            strains: &mut strains,
            between: &mut between,
            lost_work: 0.0,
        };
        let way = (Some(way[0]), way[1]);
        let update = m.integrate_along(&m.lame(), way, &self.past(), &mut memory);
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

/// Random numbers in -1 .. 1.
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
    2.0 * ((*seed >> 11) as f64 / (1u64 << 53) as f64) - 1.0
}

fn distance<const S: usize>(a: &[f64; S], b: &[f64; S]) -> f64 {
    let difference: [f64; S] = std::array::from_fn(|k| a[k] - b[k]);
    von_mises(&difference)
}

fn errors<const S: usize>(space: Space, size: f64, seed: &mut u64) -> [f64; 2] {
    let mut worst = [0.0f64; 2];
    for curve in curves() {
        for m in each_kind(material(space, 0.3, curve)) {
            for _ in 0..20 {
                let mut strain = || -> [f64; S] {
                    std::array::from_fn(|k| match (S, k) {
                        (4, 2) if space == Space::PlaneStress => 0.0,
                        _ => random(seed),
                    })
                };
                // Brought beyond yield, and on from there in another direction.
                let first = strain().map(|e| 0.01 * e);
                let turn = strain();
                let end: [f64; S] = std::array::from_fn(|k| first[k] + size * turn[k]);
                let mut point = Point::new(&m);
                for i in 1..=50 {
                    point.advance(&m, &first.map(|e| e * f64::from(i) / 50.0));
                }
                let exact = {
                    let at = |n: i32| {
                        let mut p = point.clone();
                        for i in 1..=n {
                            p.advance(&m, &between([&first, &end], f64::from(i) / f64::from(n)));
                        }
                        m.lame().stress(&end, &p.state.strain)
                    };
                    let (a, b) = (at(2000), at(4000));
                    std::array::from_fn::<f64, S, _>(|k| 2.0 * b[k] - a[k])
                };
                let whole = point.clone().advance(&m, &end);
                let followed = point.follow(&m, [&first, &end]);
                let stress = m.lame().stress(&end, &followed.state.strain);
                let scale = von_mises(&exact);
                worst[0] = worst[0].max(distance(&whole, &exact) / scale);
                worst[1] = worst[1].max(distance(&stress, &exact) / scale);
            }
        }
    }
    worst
}

#[test]
fn a_way_is_followed_however_long_it_is() {
    let mut seed = 5;
    for size in [0.0003, 0.001, 0.003, 0.01, 0.1] {
        println!(
            "{size} solid {:?}",
            errors::<6>(Space::Solid, size, &mut seed)
        );
        println!(
            "{size} plane strain {:?}",
            errors::<4>(Space::PlaneStrain, size, &mut seed)
        );
        println!(
            "{size} plane stress {:?}",
            errors::<4>(Space::PlaneStress, size, &mut seed)
        );
    }
}
