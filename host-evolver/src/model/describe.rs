//! A network in words: names, equations, an indented tree, and the data of its figures.

use super::notation::Terminal;
use super::notation::{self, Digits, Part, input_name};
use grn_core::network::{Gene, Network, Source};

/// The name of a gene: y1, y2, … and M for the last.
pub fn gene_name(network: &Network<f32>, index: usize) -> String {
    if index + 1 == network.genes().len() { "M".into() } else { format!("y{}", index + 1) }
}

fn source_name(network: &Network<f32>, source: Source) -> String {
    match source {
        Source::X1 => input_name(Terminal::X1).into(),
        Source::X2 => input_name(Terminal::X2).into(),
        Source::Gene(index) => gene_name(network, usize::from(index)),
    }
}

/// The differential equation of each gene, in the paper's notation.
pub fn equations(network: &Network<f32>, digits: Digits) -> Vec<String> {
    let equation = |(index, gene): (usize, &Gene<f32>)| {
        let operands: Vec<String> = gene.inputs.iter().map(|&source| source_name(network, source)).collect();
        let theta = digits.of(gene.theta).unwrap_or_else(|| "θ".into());
        let name = gene_name(network, index);
        let mut text = format!("d{name}/dt = -{name} + ");
        // Writing to memory cannot fail.
        let _ = gene.motif.write_formula(&mut text, &operands, theta);
        text
    };
    network.genes().iter().enumerate().map(equation).collect()
}

/// Nodes of the syntax tree, functions and terminals: the paper's f1. A gene read twice counts twice, so that the tree of a
/// network from outside may have billions.
pub fn tree_size(network: &Network<f32>) -> usize {
    let mut sizes: Vec<usize> = Vec::new();
    for gene in network.genes() {
        let size = |source: &Source| match source {
            Source::Gene(earlier) => sizes.get(usize::from(*earlier)).copied().unwrap_or(1),
            Source::X1 | Source::X2 => 1,
        };
        sizes.push(gene.inputs.iter().map(size).fold(1, usize::saturating_add));
    }
    sizes.last().copied().unwrap_or(0)
}

/// Larger syntax trees are not written out.
const MOST_NODES: usize = 1000;

/// The network unfolded into the syntax tree of M, in prefix order; a gene read twice appears twice. `None` if it has more
/// than 1000 nodes.
fn unfolded(network: &Network<f32>) -> Option<Vec<Part<f32>>> {
    let genes = network.genes();
    if tree_size(network) > MOST_NODES {
        return None;
    }
    let mut parts = Vec::new();
    let mut waiting = vec![Source::Gene((genes.len() - 1) as u8)];
    while let Some(source) = waiting.pop() {
        match source {
            Source::X1 => parts.push(Part::Input(Terminal::X1)),
            Source::X2 => parts.push(Part::Input(Terminal::X2)),
            Source::Gene(index) => {
                let gene = &genes[usize::from(index)];
                parts.push(Part::Motif(gene.motif, gene.theta, gene.inputs.len()));
                waiting.extend(gene.inputs.iter().rev());
            }
        }
    }
    Some(parts)
}

/// The network as an expression in the one [notation], or how many nodes it has if that is more than 1000.
pub fn expression(network: &Network<f32>, digits: Digits) -> String {
    match unfolded(network) {
        Some(parts) => notation::expression(parts, digits),
        None => too_large(network),
    }
}

fn too_large(network: &Network<f32>) -> String {
    format!("a tree of {} nodes, too large to be written out", tree_size(network))
}

/// The syntax tree for a figure; `None` if it has more than 1000 nodes.
pub fn syntax_tree(network: &Network<f32>) -> Option<grn_figures::SyntaxTree> {
    fn build(parts: &mut impl Iterator<Item = Part<f32>>) -> Option<grn_figures::SyntaxTree> {
        Some(match parts.next()? {
            Part::Input(input) => {
                grn_figures::SyntaxTree { label: input_name(input).into(), detail: None, children: Vec::new() }
            }
            Part::Motif(motif, theta, operands) => grn_figures::SyntaxTree {
                label: motif.name().into(),
                detail: Digits::Four.of(theta).map(|theta| format!("θ = {theta}")),
                children: (0..operands).map_while(|_| build(parts)).collect(),
            },
        })
    }
    build(&mut unfolded(network)?.into_iter())
}

/// The syntax tree as indented text, or how many nodes it has if that is more than 1000.
pub fn tree_text(network: &Network<f32>) -> String {
    fn draw(tree: &grn_figures::SyntaxTree, first: &str, rest: &str, text: &mut String) {
        let theta = tree.detail.as_ref().map(|theta| format!("  {theta}")).unwrap_or_default();
        text.push_str(&format!("{first}{}{theta}\n", tree.label));
        for (place, child) in tree.children.iter().enumerate() {
            let last = place + 1 == tree.children.len();
            let (branch, below) = if last { ("└─ ", "   ") } else { ("├─ ", "│  ") };
            draw(child, &format!("{rest}{branch}"), &format!("{rest}{below}"), text);
        }
    }
    let Some(tree) = syntax_tree(network) else { return too_large(network) + "\n" };
    let mut text = String::new();
    draw(&tree, "", "", &mut text);
    text
}

/// The genes for a GRN graph, under their names in the [`equations`].
pub fn graph(network: &Network<f32>) -> Vec<grn_figures::Gene> {
    let gene = |(index, gene): (usize, &Gene<f32>)| grn_figures::Gene {
        name: gene_name(network, index),
        motif: gene.motif.name().into(),
        theta: f64::from(gene.theta),
        inputs: gene
            .inputs
            .iter()
            .enumerate()
            .map(|(operand, &source)| grn_figures::Input {
                source: match source {
                    Source::X1 => grn_figures::Source::X1,
                    Source::X2 => grn_figures::Source::X2,
                    Source::Gene(earlier) => grn_figures::Source::Gene(usize::from(earlier)),
                },
                activates: gene.motif.rises_with(operand),
            })
            .collect(),
    };
    network.genes().iter().enumerate().map(gene).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::published::PUBLISHED;
    use crate::model::tree::Tree;
    use grn_core::motif::Motif;

    #[test]
    fn equations_read_as_in_the_paper() {
        let [point_b, ..] = &PUBLISHED;
        assert_eq!(
            equations(&point_b.network().unwrap(), Digits::Four),
            [
                "dy1/dt = -y1 + 1 - sig(x1*x1, 0.8393)",
                "dM/dt = -M + 1 - sig(y1*(1 - x2), 0.9256) - sig((1 - y1)*x2, 0.9256)",
            ]
        );
        let eh_grn = equations(&PUBLISHED[3].network().unwrap(), Digits::All);
        assert_eq!(eh_grn[12], "dM/dt = -M + sig(y10 + y11 + y12, 1.3445)");
    }

    #[test]
    fn one_model_has_one_notation_with_all_digits_four_or_none() {
        let network = |text: &str| text.parse::<Tree>().unwrap().network(1.0).unwrap();
        let text = "(XNOR[0.92561] (NAND[0.5] x1 x1) x2)";
        let tree: Tree = text.parse().unwrap();
        assert_eq!((tree.to_string(), expression(&network(text), Digits::All)), (text.into(), text.into()));
        let four = "(XNOR[0.9256] (NAND[0.5000] x1 x1) x2)";
        assert_eq!(
            (tree.expression(Digits::Four), expression(&network(text), Digits::Four)),
            (four.into(), four.into())
        );
        assert_eq!(expression(&network(text), Digits::None), "(XNOR (NAND x1 x1) x2)");
        let eh_grn = expression(&PUBLISHED[3].network().unwrap(), Digits::None);
        assert!(eh_grn.starts_with("(OR (NEG (AND (NEG x1) (NEG x2))) ("), "{eh_grn}");
    }

    #[test]
    fn a_network_that_unfolds_into_billions_of_nodes_is_described_at_once() {
        let gene = |index: u8| {
            let source = if index == 0 { Source::X1 } else { Source::Gene(index - 1) };
            Gene { motif: Motif::And, inputs: [source, source].into_iter().collect(), theta: 0.5 }
        };
        let network = Network::new(1.0, (0..32).map(gene)).unwrap();
        assert_eq!(tree_size(&network), 8_589_934_591);
        assert_eq!(expression(&network, Digits::Four), "a tree of 8589934591 nodes, too large to be written out");
        assert!(tree_text(&network).contains("8589934591 nodes") && syntax_tree(&network).is_none());
    }

    #[test]
    fn the_tree_is_drawn_with_branches() {
        let text = tree_text(&PUBLISHED[2].network().unwrap());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[..4], ["XNOR  θ = 0.2414", "├─ ANDN  θ = 1.5441", "│  ├─ x2", "│  └─ x1"]);
        assert_eq!(lines.len(), 7);
    }
}
