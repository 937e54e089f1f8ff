//! The report in a browser, at the widths of a phone and a screen.

use crate::output::report::{SCENES, drawings, write_report_of};
use crate::support::program::stderr;
use crate::support::tools;
use serde_json::Value;
use std::process::Command;

/// Chromium, by its names.
const BROWSERS: [&str; 4] = [
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
];

/// Puts the page into frames as wide as a phone and a screen and measures it there.
fn measuring_page(page: &str) -> String {
    let escaped = page.replace('&', "&amp;").replace('"', "&quot;");
    let script = r#"
window.addEventListener('load', () => {
  const found = [];
  for (const frame of document.querySelectorAll('iframe')) {
    const page = frame.contentDocument, root = page.documentElement;
    page.querySelectorAll('details').forEach(d => d.open = true);
    const wide = [...page.querySelectorAll('main *, header *, footer *')].filter(e =>
      !e.parentElement.closest('.wide') && !(e.closest('svg') && e.tagName != 'svg') &&
      e.getBoundingClientRect().right > frame.clientWidth + 0.5);
    const style = frame.contentWindow.getComputedStyle(page.body);
    found.push({
      width: frame.clientWidth, scroll: root.scrollWidth,
      wide: wide.map(e => e.tagName + '.' + e.className),
      height: root.scrollHeight,
      figures: [...page.querySelectorAll('svg')]
        .filter(s => s.getBoundingClientRect().height > 100).length,
      ink: style.color, paper: style.backgroundColor,
    });
  }
  document.body.textContent = 'MEASURED' + JSON.stringify(found) + 'END';
});"#;
    let frame = |width: u32| {
        format!(
            "<iframe style=\"width:{width}px;height:900px;border:0\" srcdoc=\"{escaped}\"></iframe>"
        )
    };
    format!(
        "<!DOCTYPE html><html><head><script>{script}</script></head><body>{}{}</body></html>",
        frame(360),
        frame(1280)
    )
}

/// Sum of the channels of `rgb(r, g, b)`.
fn brightness(color: &Value) -> u32 {
    let text = color.as_str().unwrap();
    text.split(|c: char| !c.is_ascii_digit())
        .filter_map(|n| n.parse::<u32>().ok())
        .take(3)
        .sum()
}

#[test]
fn a_browser_shows_it_without_errors_at_phone_and_screen_width_in_light_and_dark() {
    let Some(browser) = tools::first_of(&BROWSERS) else {
        return;
    };
    let temporary = tempfile::tempdir().unwrap();
    for (scene, overrides) in &SCENES[1..4] {
        let dir = temporary.path().join(scene);
        write_report_of(scene, overrides, &dir);
        let page = std::fs::read_to_string(dir.join("report.html")).unwrap();
        let n_figures = drawings(&page).len();
        let measuring = dir.join("measure.html");
        std::fs::write(&measuring, measuring_page(&page)).unwrap();
        for (scheme, dark) in [("1", false), ("0", true)] {
            let profile = temporary.path().join("profile");
            let shown = Command::new(browser)
                .args([
                    "--headless",
                    "--no-sandbox",
                    "--disable-gpu",
                    "--enable-logging=stderr",
                    "--virtual-time-budget=5000",
                ])
                .args([
                    format!("--user-data-dir={}", profile.display()),
                    format!("--blink-settings=preferredColorScheme={scheme}"),
                ])
                .args(["--window-size=1700,1000", "--dump-dom"])
                .arg(format!("file://{}", measuring.display()))
                .output()
                .unwrap();
            let dom = String::from_utf8_lossy(&shown.stdout);
            let errors = stderr(&shown);
            let console: Vec<&str> = errors.lines().filter(|l| l.contains("CONSOLE")).collect();
            assert!(console.is_empty(), "{scene}: {console:?}");
            // The script itself stands in the page, before what it found.
            let found = dom
                .rsplit("MEASURED")
                .next()
                .and_then(|t| t.split("END").next());
            let found = found.filter(|_| dom.matches("MEASURED").count() > 1);
            let found = found.unwrap_or_else(|| panic!("{browser} did not render: {errors}"));
            let found: Value = serde_json::from_str(&found.replace("&quot;", "\"")).unwrap();
            for frame in found.as_array().unwrap() {
                assert!(
                    frame["scroll"].as_u64() <= frame["width"].as_u64(),
                    "{scene}: {frame}"
                );
                assert_eq!(frame["wide"], Value::Array(vec![]), "{scene}: {frame}");
                assert_eq!(frame["figures"], n_figures, "{scene}: {frame}");
                let (ink, paper) = (brightness(&frame["ink"]), brightness(&frame["paper"]));
                assert_eq!(ink > paper, dark, "{scene}: {frame}");
                assert!(ink.abs_diff(paper) > 400, "{scene}: {frame}");
            }
        }
    }
}
