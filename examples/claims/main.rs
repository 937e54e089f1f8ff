//! The page data/accuracy/claims.md: stated errors beside true ones over families of meshes. Run
//! with `cargo run --release --example claims`. With `-- default` the page claims_default.md, of
//! families that were held out; with `-- prices` prices.md, of scenes that judge what demands cost;
//! with `-- solids` claims_solids.md.

mod calibration;
mod grading;
mod held_out_first;
mod held_out_fourth;
mod held_out_second;
mod held_out_third;
mod pressed_file;
mod prices;
mod solids;
#[path = "../../tests/support/mod.rs"]
mod support;
mod unseen;

use prices::Priced;
use std::fmt::Write;
use support::families::{self, Claim, Family};

const HEAD: &str = "# Stated errors beside true ones\n\n`cargo run --release --example claims` \
                    writes this page. Each family of meshes is run from coarse to fine; every \
                    reported quantity of every mesh is held against its closed form, or against a \
                    mesh several times finer with many more increments where there is none. Errors \
                    are relative to the largest size of the quantity in the run; those below 1e-6 \
                    are left out. Estimates are those of a run by default, which take no more than \
                    the run (`--estimate quick`).\n\nThe constants of `brinell::accuracy` come \
                    from L. Eca, M. Hoekstra 2014, P. Roache 1998 and from how an edge is read. \
                    `calibration` marks the families that were looked at while the procedure was \
                    put together; `judging` and `unseen` were looked at when the default was \
                    chosen between bounds of 1 and 0.35 of the run (at 0.35 the share within \
                    fell below 95 % in 12 of the 18 families tried, to 80 % in two). What \
                    judges the default are the families of \
                    [claims_default](claims_default.md).\n\nValues extrapolated \
                    over the three meshes are not offered as results: of 659 that showed an order \
                    which is believed, the extrapolated one was nearer to the truth than the \
                    mesh's own in 68 %, and an error for it, from its distance to other \
                    extrapolations with Roache's factor, covered 57 %.\n";

const COLUMNS: &str = "| figures | within the stated error | median of stated over true | largest \
                       true over stated |\n|---|---|---|---|---|\n";

const SOLIDS: &str = "# Stated errors of solids beside true ones\n\n`cargo run --release --example \
                      claims -- solids` writes this page: as [claims](claims.md), of solids, whose \
                      true errors are the differences from a finer mesh: 2 to 6 times finer of \
                      spheres and tubes, 1.4 to 2.4 times of the barrel and the groove, where they \
                      are about half of the error or more if it falls with the square of the \
                      element size. The families were written when the procedure was finished, and \
                      nothing of it was changed for what they showed. Since then patches end where \
                      the pairs at their edge carry their force, a plastic zone is known no finer \
                      than a layer of Gauss points, and a load that the scene gives has no row: \
                      for what other models showed.\n";

const HELD_OUT: &str = "# Stated errors by default beside true ones\n\n`cargo run --release \
                        --example claims -- default` writes this page. The default estimate takes \
                        no more time than the run itself (`--estimate quick`); meshes from files \
                        and decks are judged by the energy norm of the difference between \
                        recovered and computed stresses alone. Both sets of families were written \
                        when the procedure was finished, are of kinds that no other family has, \
                        and judged it once as it was then: the first set with 94.9 % of 1,207 \
                        figures within the stated error (82 % of loads, 79 % of plastic strains), \
                        the second with 86.5 % of 585 (69 % of rings squeezed between flats, at \
                        worst 13.9 times beyond it). What they showed has changed it since, so \
                        that the tables below, of the procedure as it is now, judge it no more: \
                        found loads follow the stress that decides them, plastic strains are \
                        known to what lies between the outermost points and the surface, and \
                        where one or two pairs carry a contact the errors of its pressures and of \
                        first yield there are unknown. The load of the deck is that of its first \
                        force on a node, which depends on the mesh. True errors are the \
                        differences from meshes two to eight times finer.\n";

const PRICES: &str = "# What demands cost\n\n`cargo run --release --example claims -- prices` \
                     writes this page. The scenes of the third set were written when the way from \
                     mesh to mesh and its estimate were finished. They judged it once; what they \
                     showed has changed it since: when a quantity counts as without a limit, and \
                     meshes are refined around contacts that they do not resolve. The four scenes \
                     of the fourth set, whose contacts at first yield are ten to forty times \
                     smaller than their elements, were written after that. They judge the method \
                     as it was then: a first run, which was stopped half way, showed that their \
                     reference solutions needed finer meshes; nothing else was changed, in the \
                     scenes or in the method. What the page showed then has changed one thing: no \
                     error is stated for a contact that a single pair carries. Crossed cylinders \
                     in space, once the tenth of the third set, are left out: with their truth and \
                     the meshes by trial they take more than 20 minutes.\n";

fn main() {
    if std::env::args()
        .nth(1)
        .is_some_and(|only| only == "default")
    {
        let folder = tempfile::tempdir().unwrap();
        let mut page = HELD_OUT.to_string();
        let groups = [
            ("second set", held_out_second::families(folder.path())),
            ("first set", held_out_first::families(folder.path())),
        ];
        for (group, families) in &groups {
            let claims = judged(group, families, &mut page, None);
            by_quantity(group, &claims, &mut page);
        }
        std::fs::write("data/accuracy/claims_default.md", page).unwrap();
        return;
    }
    if std::env::args().nth(1).is_some_and(|only| only == "prices") {
        let folder = tempfile::tempdir().unwrap();
        let mut page = PRICES.to_string();
        let mut priced = Vec::new();
        let groups = [
            ("fourth set", held_out_fourth::families(folder.path())),
            ("third set", held_out_third::families(folder.path())),
        ];
        for (group, families) in &groups {
            let claims = judged(group, families, &mut page, Some(&mut priced));
            by_quantity(group, &claims, &mut page);
        }
        page += prices::HEAD;
        page.extend(priced.iter().map(Priced::row));
        page += &prices::summary(&priced);
        std::fs::write("data/accuracy/prices.md", page).unwrap();
        return;
    }
    if std::env::args()
        .nth(1)
        .is_some_and(|only| only == "grading")
    {
        std::fs::write("data/accuracy/grading.md", grading::page()).unwrap();
        return;
    }
    if std::env::args().nth(1).is_some_and(|only| only == "solids") {
        let mut page = SOLIDS.to_string();
        let claims = judged("unseen", &solids::families(), &mut page, None);
        by_quantity("unseen", &claims, &mut page);
        std::fs::write("data/accuracy/claims_solids.md", page).unwrap();
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut judging = families::judging_exactly(folder.path());
    judging.extend(families::judging_by_finer_meshes());
    let groups = [
        ("calibration", calibration::families()),
        ("judging", judging),
        ("unseen", unseen::families(folder.path())),
    ];
    let mut page = HEAD.to_string();
    for (group, families) in &groups {
        let claims = judged(group, families, &mut page, None);
        if *group != "calibration" {
            by_quantity(group, &claims, &mut page);
        }
    }
    std::fs::write("data/accuracy/claims.md", page).unwrap();
}

/// The claims of a group's families and, where asked for, the prices of demands on them.
fn judged(
    group: &str,
    families: &[Family],
    page: &mut String,
    mut priced: Option<&mut Vec<Priced>>,
) -> Vec<Claim> {
    let (mut all, mut rows, mut without) = (Vec::new(), String::new(), Vec::new());
    for family in families {
        let known = family.known();
        let claims = family.claims_beside(&known);
        let row = row(&claims.iter().collect::<Vec<_>>());
        match claims.is_empty() {
            true => without.push(family.name.as_str()),
            false => writeln!(rows, "| {} | {row} |", family.name).unwrap(),
        }
        eprintln!("{}: {row}", family.name);
        if let Some(priced) = &mut priced {
            for demand in prices::of(family, &known) {
                eprint!("{}", demand.row());
                priced.push(demand);
            }
        }
        all.extend(claims);
    }
    write!(page, "\n## Families: {group}\n\n").unwrap();
    if !rows.is_empty() {
        write!(page, "| family {COLUMNS}{rows}").unwrap();
    }
    if !without.is_empty() {
        let (gap, names) = (if rows.is_empty() { "" } else { "\n" }, without.join("; "));
        writeln!(
            page,
            "{gap}No run of these families states an error of a compared figure: {names}."
        )
        .unwrap();
    }
    all
}

/// A group by quantity, and its errors that lie farthest beyond what was stated.
fn by_quantity(group: &str, claims: &[Claim], page: &mut String) {
    if claims.is_empty() {
        return;
    }
    write!(page, "\nBy quantity ({group}):\n\n| quantity {COLUMNS}").unwrap();
    let mut keys: Vec<&str> = claims.iter().map(Claim::key).collect();
    keys.sort_unstable();
    keys.dedup();
    for key in keys {
        let of_key: Vec<&Claim> = claims.iter().filter(|c| c.key() == key).collect();
        writeln!(page, "| `{key}` | {} |", row(&of_key)).unwrap();
    }
    let all: Vec<&Claim> = claims.iter().collect();
    writeln!(
        page,
        "| all | {} |\n\n{}",
        row(&all),
        prices_of_estimates(claims)
    )
    .unwrap();
    let mut beyond: Vec<&Claim> = claims.iter().filter(|c| c.truth > c.stated).collect();
    beyond.sort_by(|a, b| (b.truth / b.stated).total_cmp(&(a.truth / a.stated)));
    *page += "\nTrue errors that exceed the stated ones, largest ratio first:\n\n| family | mesh | \
              quantity | true | stated | order seen |\n|---|---|---|---|---|---|\n";
    for claim in beyond.iter().take(12) {
        let order = claim.order.map_or("-".to_string(), |p| format!("{p:.1}"));
        let Claim {
            family,
            mesh,
            quantity,
            truth,
            stated,
            ..
        } = claim;
        writeln!(
            page,
            "| {family} | {mesh} | {quantity} | {truth:.1e} | {stated:.1e} | {order} |"
        )
        .unwrap();
    }
}

/// What the estimates of the runs take, in a sentence.
fn prices_of_estimates(claims: &[Claim]) -> String {
    let runs = claims.chunk_by(|a, b| (&a.family, &a.mesh) == (&b.family, &b.mesh));
    let mut prices: Vec<f64> = runs.filter_map(|run| Some(run.first()?.price)).collect();
    if prices.is_empty() {
        return String::new();
    }
    prices.sort_by(f64::total_cmp);
    let [median, most] = [prices.len() / 2, prices.len().saturating_sub(1)]
        .map(|k| prices.get(k).map_or(f64::NAN, |price| 100.0 * price));
    format!(
        "\nThe estimate of a run takes {median:.0} % of its operations in the median of {} \
         runs, at most {most:.0} %.\n",
        prices.len()
    )
}

/// Number, share within, median, worst.
fn row(claims: &[&Claim]) -> String {
    if claims.is_empty() {
        return "no figures".to_string();
    }
    let within = claims.iter().filter(|c| c.truth <= c.stated).count();
    let mut ratios: Vec<f64> = claims.iter().map(|c| c.stated / c.truth).collect();
    ratios.sort_by(f64::total_cmp);
    format!(
        "{} | {:.1} % | {:.1} | {:.2}",
        claims.len(),
        100.0 * within as f64 / claims.len() as f64,
        ratios[ratios.len() / 2],
        1.0 / ratios[0]
    )
}
