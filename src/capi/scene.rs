//! Loading and parsing of scenes.

use super::border::{free, guarded, hand_out, slice, text};
use crate::deck::{self, Options};
use crate::scene::Scene;
use std::ffi::c_char;

/// A scene: what is pressed on what.
pub struct brinell_scene {
    pub(super) scene: Scene,
}

/// Reads a scene file and applies `n_overrides` texts "key.path=value" to it, as `--set` of the
/// program does: tables are merged, "key=" removes a key; NULL and 0 for none.
///
/// # Safety
/// `path` and the overrides are texts that end with a zero byte; `out` may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_scene_load(
    path: *const c_char,
    overrides: *const *const c_char,
    n_overrides: usize,
    out: *mut *mut brinell_scene,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        unsafe {
            let overrides = slice(overrides, n_overrides, "overrides")?
                .iter()
                .map(|&one| text(one, "an override").map(str::to_string))
                .collect::<crate::Result<Vec<_>>>()?;
            let scene = deck::load_with(
                text(path, "the path of the scene")?,
                &overrides,
                Options::default(),
            )?;
            hand_out(out, brinell_scene { scene })
        }
    })
}

/// Reads a scene from a text (TOML). Relative paths in it are relative to the working directory.
///
/// # Safety
/// `toml` is a text that ends with a zero byte; `out` may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_scene_parse(
    toml: *const c_char,
    out: *mut *mut brinell_scene,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        unsafe {
            let scene = Scene::parse(text(toml, "the text of the scene")?, "scene")?;
            hand_out(out, brinell_scene { scene })
        }
    })
}

/// Frees a scene.
///
/// # Safety
/// `scene` is NULL or was handed out by this library and not freed before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_scene_free(scene: *mut brinell_scene) {
    // SAFETY: as vouched for by the caller.
    unsafe { free(scene) }
}
