//! What benches share.

use kakeami::loader::MemoryLoader;
use kakeami::lower::{LowerConfig, lower};
use kakeami::scene::{Canvas, Paint};

/// The canvas and the first paint of a scene, whose text is without fault.
pub(crate) fn painted(text: &str) -> (Canvas, Paint) {
    let mut loader = MemoryLoader::default();
    loader.files.insert("bench.kake".to_owned(), text.as_bytes().into());
    let lowered = lower("bench.kake", &loader, &LowerConfig::default());
    let scene = lowered.scene.unwrap_or_else(|| unreachable!("{:?}", lowered.diagnostics));
    let paint = kakeami::paints(&scene).next().cloned();
    (scene.canvas.clone(), paint.unwrap_or_else(|| unreachable!("the scene paints once")))
}
