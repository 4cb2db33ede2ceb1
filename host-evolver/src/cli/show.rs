//! `grn show`.

use super::{Answer, Failure, about, output};
use crate::evaluation::Model;
use crate::files::{blob_bytes, read_blob};
use crate::model::describe;
use crate::model::notation::Digits;
use grn_core::blob::{Blob, FORMAT_VERSION};
use serde_json::{Value, json};
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Arguments {
    /// The controller.
    blob: PathBuf,
    /// Print JSON instead of text.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let blob = read_blob(&arguments.blob)?;
    // A blob is canonical: its file has just the bytes that it encodes to.
    let bytes = blob_bytes(&blob).map_err(|error| about(arguments.blob.display())(error).of_program())?.len();
    if arguments.json {
        output::product_json(&as_json(&blob, bytes))?;
    } else {
        output::product(as_text(&blob, bytes))?;
    }
    Ok(Answer::Yes)
}

/// What follows from the model alone.
struct Derived {
    level: f64,
    contrast: f64,
    ring_radius_m: Option<f64>,
}

fn derived(blob: &Blob) -> Option<Derived> {
    let model = Model::new(&blob.network, f64::from(blob.level_fraction)).ok()?;
    let pattern = model.pattern();
    let ring_radius_m = pattern.free_space_radius(model.network(), &blob.field.field(1.0));
    Some(Derived { level: pattern.level(), contrast: pattern.contrast(), ring_radius_m })
}

fn identity(blob: &Blob) -> String {
    blob.identity().iter().map(|byte| format!("{byte:02x}")).collect()
}

fn as_json(blob: &Blob, bytes: usize) -> Value {
    let derived = derived(blob);
    let gains = &blob.gains;
    json!({
        "identity": identity(blob),
        "format_version": FORMAT_VERSION,
        "bytes": bytes,
        "genes": blob.network.genes().len(),
        "nodes": describe::tree_size(&blob.network),
        "steepness": blob.network.steepness(),
        "thetas": blob.network.genes().iter().map(|gene| gene.theta).collect::<Vec<_>>(),
        "expression": describe::expression(&blob.network, Digits::All),
        "equations": describe::equations(&blob.network, Digits::All),
        "level": derived.as_ref().map(|d| d.level),
        "contrast": derived.as_ref().map(|d| d.contrast),
        "ring_radius_m": derived.as_ref().and_then(|d| d.ring_radius_m),
        "kernel": blob.field.kernel.name(),
        "target_width_m": blob.field.target_width,
        "obstacle_width_m": blob.field.obstacle_width,
        "level_fraction": blob.level_fraction,
        "scale": blob.scale,
        "step_s": blob.step.seconds::<f32>(),
        "time_scale": blob.time_scale,
        "gains": {
            "attraction_per_s": gains.attraction,
            "coupling": gains.coupling,
            "decay_per_s": gains.decay,
            "drive_per_s2": gains.drive,
            "repulsion_m_per_s2": gains.repulsion,
            "repulsion_range_ring_radii": gains.repulsion_range,
            "cruise_m_per_s": gains.cruise,
            "turn_per_s": gains.turn,
        },
    })
}

fn as_text(blob: &Blob, bytes: usize) -> String {
    let genes = blob.network.genes().len();
    let mut lines = vec![format!(
        "controller {} · {bytes} bytes, format {FORMAT_VERSION} · {genes} genes, {} nodes",
        identity(blob),
        describe::tree_size(&blob.network)
    )];
    lines.push(String::new());
    lines.push(describe::expression(&blob.network, Digits::Four));
    lines.push(String::new());
    lines.extend(describe::equations(&blob.network, Digits::Four));
    lines.push(format!("sig(x, θ) = 1 / (1 + exp(-{} (x - θ)))", blob.network.steepness()));
    lines.push(String::new());
    lines.push(describe::tree_text(&blob.network));
    lines.push(pattern_text(blob));
    let field = &blob.field;
    lines.push(format!(
        "inputs   {} kernel, σ_t {} m, σ_o {} m (model metres); world scale {}",
        field.kernel.name(),
        field.target_width,
        field.obstacle_width,
        blob.scale
    ));
    lines.push(format!(
        "dynamics RK4, step {} GRN s, {} GRN s per second",
        blob.step.seconds::<f32>(),
        blob.time_scale
    ));
    let gains = &blob.gains;
    lines.push(format!(
        "motion   attraction {} /s, coupling {}, decay {} /s, drive {} /s², repulsion {} m/s² within {} ring radii, cruise {} m/s, turn {} /s",
        gains.attraction,
        gains.coupling,
        gains.decay,
        gains.drive,
        gains.repulsion,
        gains.repulsion_range,
        gains.cruise,
        gains.turn
    ));
    lines.join("\n")
}

fn pattern_text(blob: &Blob) -> String {
    let Some(Derived { level, contrast, ring_radius_m }) = derived(blob) else {
        return "pattern  none: the model does not tell a target from empty space".into();
    };
    let side = if contrast > 0.0 { "above" } else { "below" };
    let ring = match ring_radius_m {
        Some(radius) => format!(
            "a ring of radius {radius:.4} m around a lone target ({:.4} m in the world)",
            radius * f64::from(blob.scale)
        ),
        None => "no ring around a lone target".into(),
    };
    format!("pattern  M = {level:.6}, inside {side} it; contrast {contrast:.6}; {ring}")
}
