//! The figures of the paper, and the readings of its "hardening coefficient 0.6", computed anew.
//!
//! ```text
//! cargo run --release --example paper_figures              # everything
//! cargo run --release --example paper_figures -- figures   # data/figures/*.svg alone
//! cargo run --release --example paper_figures -- readings  # hardening_readings.csv alone
//! cargo run --release --example paper_figures -- verification  # data/verification.md alone
//! cargo run --release --example paper_figures -- validation  # data/validation.md alone
//! ```

mod chart;
mod cylinder;
mod disc;
mod readings;
mod runs;
mod validation;
mod verification;
mod zone;

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

fn main() -> Outcome<()> {
    let what: Vec<String> = std::env::args().skip(1).collect();
    let asked = |name: &str| what.is_empty() || what.iter().any(|w| w == name);
    if let Some(unknown) = what
        .iter()
        .find(|w| !["figures", "readings", "verification", "validation"].contains(&w.as_str()))
    {
        return Err(format!(
            "`{unknown}`: there are `figures`, `readings`, `verification` and `validation`"
        )
        .into());
    }
    if asked("figures") {
        std::fs::create_dir_all(runs::data("figures"))?;
        cylinder::draw()?;
        disc::draw()?;
    }
    if asked("readings") {
        readings::write()?;
    }
    if asked("verification") {
        verification::write()?;
    }
    if asked("validation") {
        validation::write()?;
    }
    Ok(())
}
