//! The network a model stands for: genes, what they read, and what promotes or represses them.

use crate::canvas::error::{FigureError, finite};
use crate::canvas::note::nothing_to_draw;
use crate::canvas::paint::{Paint, Rect};
use crate::canvas::style::{COLUMN, INK, SMALL, VERMILLION};
use crate::canvas::svg::Svg;
use crate::canvas::text::width;
use crate::chart::legend::{Key, legend};
use crate::grn::data::{Gene, Input, Source};
use crate::grn::draw::{Columns, Edge, GENE_HEIGHT, RADIUS, arrow, bar, draw_edge, draw_gene, layers};
use crate::grn::layout::Layout;
use crate::tree;

const GENES: usize = 64;

/// Draws a network in layers from the inputs on the left to the pattern morphogen, which has a double
/// frame, on the right. Arrowheads promote, bars repress. Of more than 64 genes the figure says only how many they are.
///
/// # Errors
/// A gene without inputs or reading one that is not earlier, a θ that is not finite.
pub fn grn(genes: &[Gene]) -> Result<String, FigureError> {
    check(genes)?;
    if genes.is_empty() {
        return Ok(nothing_to_draw("the network has no gene"));
    }
    if genes.len() > GENES {
        return Ok(nothing_to_draw(&format!("{} genes are too many for a figure", genes.len())));
    }
    let layers = layers(genes);
    let mut layout = Layout::default();
    let reads = |source| genes.iter().flat_map(|g| &g.inputs).any(|i| i.source == source);
    let x1 = reads(Source::X1).then(|| layout.add(0, 2.0 * RADIUS));
    let x2 = reads(Source::X2).then(|| layout.add(0, 2.0 * RADIUS));
    let boxes: Vec<usize> = layers.iter().map(|&layer| layout.add(layer, GENE_HEIGHT)).collect();
    let node_of = |source: Source| match source {
        Source::X1 => x1.unwrap_or_default(),
        Source::X2 => x2.unwrap_or_default(),
        Source::Gene(g) => boxes[g],
    };
    let mut routes = Vec::new();
    for (gene, to) in genes.iter().zip(&boxes) {
        let route = |input: &Input| (node_of(input.source), layout.connect(node_of(input.source), *to));
        routes.push(gene.inputs.iter().map(route).collect::<Vec<_>>());
    }
    let height = layout.arrange();
    let columns = Columns::new(genes, &layers, layout.nodes.len());
    let top = 6.0;
    let mut svg = Svg::default();
    let rect = |g: usize| {
        let (x, w) = columns.places[layers[g]];
        let w_box = columns.gene_widths[g];
        let y = top + layout.nodes[boxes[g]].y - GENE_HEIGHT / 2.0;
        Rect::new(x + (w - w_box) / 2.0, y, w_box, GENE_HEIGHT)
    };
    for g in 0..genes.len() {
        // Ports from top to bottom in the order in which the edges arrive.
        let arrival = |(from, passed): &(usize, Vec<usize>)| layout.nodes[*passed.last().unwrap_or(from)].y;
        let mut order: Vec<usize> = (0..routes[g].len()).collect();
        order.sort_by(|&a, &b| arrival(&routes[g][a]).total_cmp(&arrival(&routes[g][b])));
        let step = (GENE_HEIGHT * 0.62 / order.len() as f64).min(11.0);
        for (port, &i) in order.iter().enumerate() {
            let (from, passed) = &routes[g][i];
            let twins: Vec<usize> =
                order.iter().copied().filter(|&j| genes[g].inputs[j].source == genes[g].inputs[i].source).collect();
            let turn = twins.iter().position(|&j| j == i).unwrap_or(0) as f64 - (twins.len() - 1) as f64 / 2.0;
            let shift = turn * (12.0 / twins.len() as f64).min(6.0);
            let start_y = top + layout.nodes[*from].y + shift;
            let start_x = match genes[g].inputs[i].source {
                Source::Gene(source) => rect(source).right(),
                _ => columns.places[0].0 + RADIUS + libm::sqrt((RADIUS * RADIUS - shift * shift).max(0.0)),
            };
            let mut path = vec![(start_x, start_y)];
            for &place in passed {
                let (x, w) = columns.places[layout.nodes[place].layer];
                path.extend([(x, top + layout.nodes[place].y), (x + w, top + layout.nodes[place].y)]);
            }
            let end = rect(g);
            let y = end.y + GENE_HEIGHT / 2.0 + (port as f64 - (order.len() - 1) as f64 / 2.0) * step;
            path.push((end.x, y));
            draw_edge(&mut svg, &Edge { path, activates: genes[g].inputs[i].activates });
        }
    }
    let middle = columns.places[0].0 + RADIUS;
    for (node, name) in [(x1, "x1"), (x2, "x2")] {
        if let Some(node) = node {
            tree::input(&mut svg, name, (middle, top + layout.nodes[node].y), RADIUS);
        }
    }
    for (g, gene) in genes.iter().enumerate() {
        draw_gene(&mut svg, gene, &rect(g), g + 1 == genes.len());
    }
    let total = columns.right.max(COLUMN * 0.6);
    let look = |colour| Paint::stroke(colour, 1.0);
    let promotes = (Key::Line(look(INK)), "promotes");
    let represses = (Key::Line(look(VERMILLION)), "represses");
    let base = top + height + 18.0;
    let second = 19.0 + width(promotes.1, SMALL, false) + 11.0;
    let x = ((total - second - 19.0 - width(represses.1, SMALL, false)) / 2.0).max(4.0);
    legend(&mut svg, x, base, total, SMALL, &[promotes, represses]);
    let key_y = base - SMALL * 0.34;
    arrow(&mut svg, (x + 16.8, key_y));
    bar(&mut svg, (x + second + 15.4, key_y));
    Ok(svg.finish(total, base + 6.0))
}

fn check(genes: &[Gene]) -> Result<(), FigureError> {
    finite("θ of gene", genes.iter().map(|g| g.theta))?;
    let late = |(i, gene): (usize, &Gene)| {
        let earlier = |input: &Input| !matches!(input.source, Source::Gene(j) if j >= i);
        gene.inputs.is_empty() || !gene.inputs.iter().all(earlier)
    };
    match genes.iter().enumerate().position(late) {
        Some(index) => {
            let expected = "a reader of inputs or earlier genes";
            Err(FigureError::OutOfRange { what: "gene", index, expected })
        }
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::check::read;

    fn gene(name: &str, inputs: &[(Source, bool)]) -> Gene {
        let inputs = inputs.iter().map(|&(source, activates)| Input { source, activates }).collect();
        Gene { name: name.into(), motif: "XNOR".into(), theta: 0.8393, inputs }
    }

    fn pair() -> Vec<Gene> {
        vec![
            gene("G1", &[(Source::X1, false), (Source::X1, false)]),
            gene("G2", &[(Source::Gene(0), true), (Source::X2, false)]),
        ]
    }

    #[test]
    fn a_source_read_twice_gives_two_edges() {
        let svg = grn(&pair()).unwrap();
        assert_eq!(svg, grn(&pair()).unwrap());
        let document = read(&svg);
        assert_eq!(document.count("class=\"gene\""), 2);
        let edges: Vec<&String> = document.tags.iter().filter(|t| t.starts_with("path") && t.contains('C')).collect();
        let mut distinct = edges.clone();
        distinct.dedup();
        assert_eq!(edges.len(), 4);
        assert_eq!(distinct.len(), 4);
        assert!(document.says("G1") && document.says("θ = 0.8393") && document.says("x2"));
    }

    #[test]
    fn the_pattern_gene_is_alone_at_the_end() {
        let mut genes = pair();
        genes.push(gene("G3", &[(Source::X1, true)]));
        assert_eq!(layers(&genes), [1, 2, 3]);
    }

    #[test]
    fn no_gene_and_too_many_are_said() {
        assert!(read(&grn(&[]).unwrap()).texts.concat().starts_with("Nothing to draw"));
        let many = vec![gene("G1", &[(Source::X1, true)]); 65];
        assert!(read(&grn(&many).unwrap()).texts.concat().contains("65 genes"));
    }

    #[test]
    fn bad_networks_are_refused() {
        let mut genes = pair();
        genes[0].theta = f64::INFINITY;
        assert_eq!(grn(&genes), Err(FigureError::NotFinite { what: "θ of gene", index: 0 }));
        let own = [gene("G1", &[(Source::Gene(0), true)])];
        assert!(matches!(grn(&own), Err(FigureError::OutOfRange { index: 0, .. })));
        assert!(matches!(grn(&[gene("G1", &[])]), Err(FigureError::OutOfRange { index: 0, .. })));
    }
}
