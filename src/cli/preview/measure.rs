//! What the patterns of a picture measure, with their charts.

use serde_json::{Map, Value, json};

use crate::diag::grouped;
use crate::illustrate::{Sketch, illustrate};
use crate::metrics::{Measured, Measures};
use crate::scene::Limits;
use crate::stop::Stop;
use crate::{PaintStages, paints};

use super::pictures::Picture;

/// Pictures of more tiles are not measured beside the page: that takes minutes.
const MOST_TILES: u64 = 200_000;

/// Measures every paint that was drawn.
///
/// # Errors
/// In words, where there is too much to measure.
pub(super) fn measure(picture: &Picture, limits: &Limits, stop: &Stop) -> Result<Value, String> {
    if picture.tiles > MOST_TILES {
        let (tiles, most) = (grouped(picture.tiles), grouped(MOST_TILES));
        return Err(format!("the picture has {tiles} tiles; above {most} `kake metrics` measures"));
    }
    let limits = Limits { stop: stop.clone(), ..limits.clone() };
    let (mut list, mut charts) = (Vec::new(), Map::new());
    let scene = &picture.scene;
    for paint in paints(scene).filter(|paint| picture.only.as_ref().is_none_or(|only| paint.name == *only)) {
        let stages = PaintStages::new(paint, &scene.canvas, &limits, &mut (), &mut Vec::new());
        let stages = stages.map_err(|diagnostic| diagnostic.message)?;
        let measured = Measured::new(paint, &stages.borrow());
        if stop.is_asked() {
            return Err("nobody waits for these figures any more".to_owned());
        }
        let measures = Measures::new(&measured);
        let sketch = Sketch::new(&measured, &measures);
        let drawn = illustrate(&paint.name, &[sketch]).into_iter();
        let drawn: Map<String, Value> = drawn.map(|chart| (chart.kind.to_owned(), json!(chart.svg))).collect();
        charts.insert(paint.name.clone(), Value::Object(drawn));
        let mut entry = serde_json::to_value(&measures).map_err(|error| error.to_string())?;
        entry["paint"] = json!(paint.name);
        entry["seed"] = json!(scene.seed);
        list.push(entry);
    }
    Ok(json!({ "paints": list, "charts": charts }))
}
