//! The syntax tree of a model.

use crate::canvas::note::nothing_to_draw;
use crate::canvas::paint::{Anchor, Font, Paint, Rect};
use crate::canvas::style::{BLUE, BLUE_TINT, BOX_TINT, INK, LABEL, ORANGE, ORANGE_TINT, SMALL, THIN};
use crate::canvas::svg::Svg;
use crate::canvas::text::width;

/// A node of a syntax tree: a motif with its operands, or a terminal without.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SyntaxTree {
    /// `NAND`, …, or `x1` and `x2`.
    pub label: String,
    /// What stands beneath a motif's name, such as its `θ = 0.8393`.
    pub detail: Option<String>,
    /// Its operands in order.
    pub children: Vec<SyntaxTree>,
}

const LEVEL: f64 = 44.0;
const GAP: f64 = 9.0;
const RADIUS: f64 = 9.5;
const BOX_HEIGHT: f64 = 25.0;
const DEPTH: usize = 64;
const NODES: usize = 1024;

/// A node in its place: `x` is its middle relative to its parent's.
struct Placed<'a> {
    node: &'a SyntaxTree,
    x: f64,
    children: Vec<Placed<'a>>,
    /// For each level from this one downwards, how far the subtree reaches to the left and to the right.
    reach: Vec<(f64, f64)>,
}

/// Draws a syntax tree as wide as it needs to be: motifs as boxes, terminals as circles. Subtrees are packed
/// by their outlines and parents centred over their operands (Reingold and Tilford 1981). Of a tree deeper than 64
/// levels or with more than 1024 nodes the figure says only that it is too large.
#[must_use]
pub fn tree(root: &SyntaxTree) -> String {
    let mut waiting = vec![(root, 1_usize)];
    let (mut nodes, mut depth) = (0, 0);
    while let Some((node, level)) = waiting.pop() {
        nodes += 1;
        depth = depth.max(level);
        if depth > DEPTH || nodes > NODES {
            return nothing_to_draw(&format!("the tree has more than {NODES} nodes or {DEPTH} levels"));
        }
        waiting.extend(node.children.iter().map(|child| (child, level + 1)));
    }
    let placed = place(root);
    let left = placed.reach.iter().map(|r| r.0).fold(0.0, f64::min);
    let right = placed.reach.iter().map(|r| r.1).fold(0.0, f64::max);
    let mut svg = Svg::default();
    let top = 4.0 + BOX_HEIGHT / 2.0;
    edges(&mut svg, &placed, 4.0 - left, top);
    shapes(&mut svg, &placed, 4.0 - left, top);
    let foot = if depth == 1 && root.children.is_empty() { BOX_HEIGHT / 2.0 } else { RADIUS };
    svg.finish(right - left + 8.0, top + (depth - 1) as f64 * LEVEL + foot.max(bottom(&placed, depth)) + 4.0)
}

/// Half the height of the lowest level.
fn bottom(placed: &Placed<'_>, depth: usize) -> f64 {
    fn has_box(placed: &Placed<'_>, level: usize) -> bool {
        if level == 1 {
            return !is_input(placed.node);
        }
        placed.children.iter().any(|child| has_box(child, level - 1))
    }
    if has_box(placed, depth) { BOX_HEIGHT / 2.0 } else { RADIUS }
}

fn is_input(node: &SyntaxTree) -> bool {
    node.children.is_empty() && node.detail.is_none()
}

fn half_width(node: &SyntaxTree) -> f64 {
    if is_input(node) {
        return RADIUS.max(width(&node.label, LABEL, false) / 2.0 + 3.0);
    }
    let detail = node.detail.as_ref().map_or(0.0, |d| width(d, SMALL, false));
    (width(&node.label, LABEL, true).max(detail) / 2.0 + 5.0).max(16.0)
}

fn place(node: &SyntaxTree) -> Placed<'_> {
    let mut children: Vec<Placed<'_>> = node.children.iter().map(place).collect();
    // The outline of the children placed so far, level by level.
    let mut outline: Vec<(f64, f64)> = Vec::new();
    for child in &mut children {
        let shift =
            outline.iter().zip(&child.reach).map(|(done, new)| done.1 + GAP - new.0).fold(f64::NEG_INFINITY, f64::max);
        child.x = if shift.is_finite() { shift } else { 0.0 };
        for (level, reach) in child.reach.iter().enumerate() {
            let moved = (reach.0 + child.x, reach.1 + child.x);
            match outline.get_mut(level) {
                Some(done) => *done = (done.0.min(moved.0), done.1.max(moved.1)),
                None => outline.push(moved),
            }
        }
    }
    let middle = match (children.first(), children.last()) {
        (Some(first), Some(last)) => (first.x + last.x) / 2.0,
        _ => 0.0,
    };
    for child in &mut children {
        child.x -= middle;
    }
    let half = half_width(node);
    let mut reach = vec![(-half, half)];
    reach.extend(outline.into_iter().map(|(l, r)| (l - middle, r - middle)));
    Placed { node, x: 0.0, children, reach }
}

fn edges(svg: &mut Svg, placed: &Placed<'_>, x: f64, y: f64) {
    for child in &placed.children {
        svg.line((x, y), (x + child.x, y + LEVEL), &Paint::stroke(INK, 0.8));
        edges(svg, child, x + child.x, y + LEVEL);
    }
}

fn shapes(svg: &mut Svg, placed: &Placed<'_>, x: f64, y: f64) {
    let node = placed.node;
    if is_input(node) {
        svg.open("terminal", "");
        input(svg, &node.label, (x, y), half_width(node));
    } else {
        svg.open("motif", "");
        let half = half_width(node);
        let rect = Rect::new(x - half, y - BOX_HEIGHT / 2.0, 2.0 * half, BOX_HEIGHT);
        svg.rect(&rect, 4.0, &Paint::stroke(INK, THIN).filled(BOX_TINT));
        let name = Font::new(LABEL, Anchor::Middle).bold();
        match &node.detail {
            Some(detail) => {
                svg.text(&node.label, (x, y - 1.6), &name);
                svg.text(detail, (x, y + 8.2), &Font::new(SMALL, Anchor::Middle));
            }
            None => svg.text(&node.label, (x, y + 2.8), &name),
        }
    }
    svg.close();
    for child in &placed.children {
        shapes(svg, child, x + child.x, y + LEVEL);
    }
}

/// Draws an input: `x1`, the targets, on blue; `x2`, the obstacles, on orange with a second ring.
pub(crate) fn input(svg: &mut Svg, label: &str, at: (f64, f64), radius: f64) {
    let (line, tint) = match label {
        "x1" | "x₁" => (BLUE, BLUE_TINT),
        "x2" | "x₂" => (ORANGE, ORANGE_TINT),
        _ => (INK, "#FFFFFF"),
    };
    svg.circle(at, radius, &Paint::stroke(line, 1.0).filled(tint));
    if line == ORANGE {
        svg.circle(at, radius - 1.8, &Paint::stroke(line, 0.5));
    }
    svg.text(label, (at.0, at.1 + 2.2), &Font::new(LABEL, Anchor::Middle));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::check::read;

    fn leaf(label: &str) -> SyntaxTree {
        SyntaxTree { label: label.into(), detail: None, children: vec![] }
    }

    fn motif(label: &str, children: Vec<SyntaxTree>) -> SyntaxTree {
        SyntaxTree { label: label.into(), detail: Some("θ = 0.5".into()), children }
    }

    #[test]
    fn every_node_is_drawn_once() {
        let sample = motif("XNOR", vec![motif("NAND", vec![leaf("x1"), leaf("x1")]), leaf("x2")]);
        let svg = tree(&sample);
        assert_eq!(svg, tree(&sample));
        let document = read(&svg);
        assert_eq!(document.count("class=\"motif\""), 2);
        assert_eq!(document.count("class=\"terminal\""), 3);
        assert!(document.says("XNOR") && document.says("θ = 0.5") && document.says("x2"));
    }

    #[test]
    fn nodes_of_a_level_never_overlap() {
        fn full(depth: usize) -> SyntaxTree {
            if depth == 0 {
                return leaf("x1");
            }
            let lone = if depth.is_multiple_of(2) { vec![full(depth - 1)] } else { vec![full(depth - 1), leaf("x2")] };
            motif("XNOR", vec![full(depth - 1), motif("POS", lone)])
        }
        fn spans(placed: &Placed<'_>, x: f64, level: usize, out: &mut Vec<(usize, f64, f64)>) {
            let half = half_width(placed.node);
            out.push((level, x - half, x + half));
            for child in &placed.children {
                spans(child, x + child.x, level + 1, out);
            }
        }
        let root = full(5);
        let mut all = Vec::new();
        spans(&place(&root), 0.0, 0, &mut all);
        all.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        assert!(all.len() > 60);
        for pair in all.windows(2) {
            assert!(pair[0].0 != pair[1].0 || pair[0].2 + GAP * 0.999 <= pair[1].1, "{pair:?}");
        }
    }

    #[test]
    fn of_an_absurd_tree_the_figure_says_that_it_is_too_large() {
        let mut deep = leaf("x1");
        for _ in 0..80 {
            deep = motif("POS", vec![deep]);
        }
        let wide = motif("OR", vec![leaf("x1"); 2000]);
        for absurd in [deep, wide] {
            assert!(read(&tree(&absurd)).texts.concat().starts_with("Nothing to draw: the tree has"));
        }
        read(&tree(&leaf("")));
    }
}
