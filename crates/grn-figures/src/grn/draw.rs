//! The shapes of a network's figure, and the columns they stand in.

use crate::canvas::format::num;
use crate::canvas::paint::{Anchor, Font, Paint, Rect};
use crate::canvas::style::{BLUE, BOX_TINT, COLUMN, INK, LABEL, SMALL, THIN, VERMILLION};
use crate::canvas::svg::{Svg, poly};
use crate::canvas::text::width;
use crate::grn::data::{Gene, Source};
use std::fmt::Write as _;

pub(crate) const GENE_HEIGHT: f64 = 35.0;
pub(crate) const RADIUS: f64 = 9.5;

/// An edge on its way: its places on paper from the source to the port of the gene.
pub(crate) struct Edge {
    pub path: Vec<(f64, f64)>,
    pub activates: bool,
}

/// The layer of each gene: one after the last it reads; the pattern morphogen is alone in the last.
pub(crate) fn layers(genes: &[Gene]) -> Vec<usize> {
    let mut layers: Vec<usize> = Vec::with_capacity(genes.len());
    for gene in genes {
        let deepest = gene.inputs.iter().map(|input| match input.source {
            Source::Gene(g) => layers.get(g).copied().unwrap_or(0),
            _ => 0,
        });
        layers.push(deepest.max().unwrap_or(0) + 1);
    }
    if let Some((last, others)) = layers.split_last_mut() {
        *last = (*last).max(others.iter().max().map_or(1, |deepest| deepest + 1));
    }
    layers
}

/// Where the layers stand.
pub(crate) struct Columns {
    pub gene_widths: Vec<f64>,
    /// Left edge and width of each layer.
    pub places: Vec<(f64, f64)>,
    pub right: f64,
}

impl Columns {
    pub fn new(genes: &[Gene], layers: &[usize], nodes: usize) -> Self {
        let gene_width = |gene: &Gene| {
            let name = name_font().width(&gene.name);
            let motif = width(&gene.motif, SMALL, false);
            name.max(motif).max(width(&theta(gene), SMALL, false)) + 9.0
        };
        let mut gene_widths: Vec<f64> = genes.iter().map(gene_width).collect();
        if let Some(last) = gene_widths.last_mut() {
            *last += 5.0; // for its double frame
        }
        let count = layers.iter().max().map_or(1, |deepest| deepest + 1);
        let mut widths = vec![0.0_f64; count];
        widths[0] = 2.0 * RADIUS;
        for (&layer, w) in layers.iter().zip(&gene_widths) {
            widths[layer] = widths[layer].max(*w);
        }
        // Networks with many edges get more room between the layers.
        let natural = if nodes > 12 { 36.0 } else { 30.0 };
        let used: f64 = widths.iter().sum::<f64>() + natural * (count - 1) as f64 + 12.0;
        let spare = (COLUMN * 0.6 - used).max(0.0);
        let gap = natural + (spare / (count - 1).max(1) as f64).min(14.0);
        let used = widths.iter().sum::<f64>() + gap * (count - 1) as f64 + 12.0;
        let mut x = 6.0 + (COLUMN * 0.6 - used).max(0.0) / 2.0;
        let mut places = Vec::with_capacity(count);
        for w in widths {
            places.push((x, w));
            x += w + gap;
        }
        Self { gene_widths, places, right: x - gap + 6.0 }
    }
}

pub(crate) fn name_font() -> Font {
    Font::new(LABEL + 0.5, Anchor::Middle).bold().symbol()
}

pub(crate) fn theta(gene: &Gene) -> String {
    format!("θ = {:.4}", gene.theta)
}

pub(crate) fn draw_gene(svg: &mut Svg, gene: &Gene, rect: &Rect, last: bool) {
    svg.open("gene", &format!("{} = {}, θ = {}", gene.name, gene.motif, gene.theta));
    let line = if last { BLUE } else { INK };
    svg.rect(rect, 4.0, &Paint::stroke(line, if last { 1.2 } else { THIN }).filled(BOX_TINT));
    if last {
        let inner = Rect::new(rect.x + 1.9, rect.y + 1.9, rect.w - 3.8, rect.h - 3.8);
        svg.rect(&inner, 2.6, &Paint::stroke(line, 0.5));
    }
    let middle = rect.x + rect.w / 2.0;
    svg.text(&gene.name, (middle, rect.y + 10.6), &name_font());
    svg.text(&gene.motif, (middle, rect.y + 20.6), &Font::new(SMALL, Anchor::Middle));
    svg.text(&theta(gene), (middle, rect.y + 29.8), &Font::new(SMALL, Anchor::Middle));
    svg.close();
}

/// Draws an edge as a curve that is level wherever it starts, ends, or passes a layer.
pub(crate) fn draw_edge(svg: &mut Svg, edge: &Edge) {
    let (Some(start), Some(end)) = (edge.path.first(), edge.path.last()) else {
        return;
    };
    let short = if edge.activates { 4.0 } else { 2.6 };
    let mut d = format!("M{} {}", num(start.0), num(start.1));
    for (i, pair) in edge.path.windows(2).enumerate() {
        let (from, mut to) = (pair[0], pair[1]);
        if i + 2 == edge.path.len() {
            to.0 = end.0 - short;
        }
        // The second of two places in one layer is reached on the level.
        let bend = (to.0 - from.0) * 0.5;
        let lead = if i + 2 == edge.path.len() { (to.0 - from.0) * 0.55 } else { bend };
        let numbers = [from.0 + bend, from.1, to.0 - lead, to.1, to.0, to.1].map(num);
        let _ = write!(d, "C{}", numbers.join(" "));
    }
    let colour = if edge.activates { INK } else { VERMILLION };
    svg.path(&d, &Paint::stroke(colour, 0.9));
    if edge.activates {
        arrow(svg, *end);
    } else {
        bar(svg, (end.0 - 2.4, end.1));
    }
}

pub(crate) fn arrow(svg: &mut Svg, tip: (f64, f64)) {
    let (x, y) = (tip.0 - 0.4, tip.1);
    let points = [(x, y), (x - 5.0, y - 2.3), (x - 3.9, y), (x - 5.0, y + 2.3)];
    svg.path(&poly(&points, true), &Paint::fill(INK));
}

pub(crate) fn bar(svg: &mut Svg, at: (f64, f64)) {
    svg.line((at.0, at.1 - 3.3), (at.0, at.1 + 3.3), &Paint::stroke(VERMILLION, 1.5));
}
