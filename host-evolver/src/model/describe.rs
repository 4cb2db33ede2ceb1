//! A network in words: names, equations, an indented tree, and the data of its figures.

use grn_core::network::{Gene, Network, Source};

/// The name of a gene: y1, y2, … and M for the last.
pub fn gene_name(network: &Network<f32>, index: usize) -> String {
    if index + 1 == network.genes().len() { "M".into() } else { format!("y{}", index + 1) }
}

fn source_name(network: &Network<f32>, source: Source) -> String {
    match source {
        Source::X1 => "x1".into(),
        Source::X2 => "x2".into(),
        Source::Gene(index) => gene_name(network, usize::from(index)),
    }
}

/// The differential equation of each gene, in the paper's notation.
pub fn equations(network: &Network<f32>) -> Vec<String> {
    let equation = |(index, gene): (usize, &Gene<f32>)| {
        let name = gene_name(network, index);
        format!("d{name}/dt = -{name} + {}", regulation(network, gene))
    };
    network.genes().iter().enumerate().map(equation).collect()
}

fn regulation(network: &Network<f32>, gene: &Gene<f32>) -> String {
    let names: Vec<String> = gene.inputs.iter().map(|&source| source_name(network, source)).collect();
    let a = names.first().map_or("", String::as_str);
    let b = names.get(1).map_or("", String::as_str);
    let formula = gene.motif.formula().replace("a + b + …", &names.join(" + "));
    formula.replace('a', a).replace('b', b).replace('θ', &gene.theta.to_string())
}

/// The network unfolded into a syntax tree from M down; a gene read twice appears twice.
pub fn syntax_tree(network: &Network<f32>) -> grn_figures::SyntaxTree {
    subtree(network, Source::Gene((network.genes().len() - 1) as u8))
}

fn subtree(network: &Network<f32>, source: Source) -> grn_figures::SyntaxTree {
    match source {
        Source::X1 | Source::X2 => {
            grn_figures::SyntaxTree { label: source_name(network, source), detail: None, children: Vec::new() }
        }
        Source::Gene(index) => {
            let gene = &network.genes()[usize::from(index)];
            grn_figures::SyntaxTree {
                label: gene.motif.name().into(),
                detail: Some(format!("{}", gene.theta)),
                children: gene.inputs.iter().map(|&input| subtree(network, input)).collect(),
            }
        }
    }
}

/// Nodes of the syntax tree, functions and terminals: the paper's f1.
pub fn tree_size(network: &Network<f32>) -> usize {
    fn size(tree: &grn_figures::SyntaxTree) -> usize {
        1 + tree.children.iter().map(size).sum::<usize>()
    }
    size(&syntax_tree(network))
}

/// The syntax tree in function notation, with θ in brackets: `(XNOR[0.9256] (NAND[0.8393] x1 x1) x2)`.
pub fn expression(network: &Network<f32>) -> String {
    fn write(tree: &grn_figures::SyntaxTree) -> String {
        let Some(theta) = &tree.detail else { return tree.label.clone() };
        let operands: String = tree.children.iter().map(|child| format!(" {}", write(child))).collect();
        format!("({}[{theta}]{operands})", tree.label)
    }
    write(&syntax_tree(network))
}

/// An [`expression`] without θ, in function notation: `XNOR(NAND(x1, x1), x2)`.
pub fn without_theta(expression: &str) -> String {
    let mut text = String::new();
    let mut in_theta = false;
    for character in expression.chars() {
        match character {
            '[' => in_theta = true,
            ']' => in_theta = false,
            _ if in_theta || character == '(' => {}
            // The first operand follows its function, the others an operand.
            ' ' if text.ends_with(|last: char| last.is_ascii_uppercase()) => text.push('('),
            ' ' => text.push_str(", "),
            other => text.push(other),
        }
    }
    text
}

/// The syntax tree as indented text.
pub fn tree_text(network: &Network<f32>) -> String {
    fn draw(tree: &grn_figures::SyntaxTree, first: &str, rest: &str, text: &mut String) {
        let theta = tree.detail.as_ref().map(|theta| format!("  θ = {theta}")).unwrap_or_default();
        text.push_str(&format!("{first}{}{theta}\n", tree.label));
        for (place, child) in tree.children.iter().enumerate() {
            let last = place + 1 == tree.children.len();
            let (branch, below) = if last { ("└─ ", "   ") } else { ("├─ ", "│  ") };
            draw(child, &format!("{rest}{branch}"), &format!("{rest}{below}"), text);
        }
    }
    let mut text = String::new();
    draw(&syntax_tree(network), "", "", &mut text);
    text
}

/// The genes for a GRN graph, G1, G2, … in order.
pub fn graph(network: &Network<f32>) -> Vec<grn_figures::Gene> {
    let gene = |(index, gene): (usize, &Gene<f32>)| grn_figures::Gene {
        name: format!("G{}", index + 1),
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

    #[test]
    fn equations_read_as_in_the_paper() {
        let [point_b, ..] = &PUBLISHED;
        assert_eq!(
            equations(&point_b.network().unwrap()),
            [
                "dy1/dt = -y1 + 1 - sig(x1*x1, 0.8393)",
                "dM/dt = -M + 1 - sig(y1*(1 - x2), 0.9256) - sig((1 - y1)*x2, 0.9256)",
            ]
        );
        let eh_grn = equations(&PUBLISHED[3].network().unwrap());
        assert_eq!(eh_grn[12], "dM/dt = -M + sig(y10 + y11 + y12, 1.3445)");
    }

    #[test]
    fn the_tree_is_drawn_with_branches() {
        let text = tree_text(&PUBLISHED[2].network().unwrap());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[..4], ["XNOR  θ = 0.2414", "├─ ANDN  θ = 1.5441", "│  ├─ x2", "│  └─ x1"]);
        assert_eq!(lines.len(), 7);
    }
}
