//! Syntax trees of network motifs: what genetic programming varies.

use super::notation::{self, Digits, Part, Terminal};
use grn_core::motif::Motif;
use grn_core::network::{DEFAULT_GENES, Gene, Network, NetworkError, Source};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::Range;

/// A node without its parameter: what decides whether two trees have the same structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Symbol {
    /// An input.
    Terminal(Terminal),
    /// A motif with as many children as [`children_of`] says.
    Motif(Motif),
}

/// A node of a syntax tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Node {
    /// An input.
    Terminal(Terminal),
    /// A motif and its threshold θ in [0, 2].
    Motif(Motif, f64),
}

/// How many children a motif has in a tree: evolution gives OR and NOR two.
pub fn children_of(motif: Motif) -> usize {
    *motif.arity().start()
}

impl Node {
    /// How many children the node has.
    pub fn children(self) -> usize {
        match self {
            Node::Terminal(_) => 0,
            Node::Motif(motif, _) => children_of(motif),
        }
    }

    /// The node without θ.
    pub fn symbol(self) -> Symbol {
        match self {
            Node::Terminal(terminal) => Symbol::Terminal(terminal),
            Node::Motif(motif, _) => Symbol::Motif(motif),
        }
    }
}

/// A syntax tree: its nodes in prefix order, root first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct Tree {
    nodes: Vec<Node>,
}

impl Tree {
    /// A tree from nodes in prefix order; the caller guarantees that they form exactly one tree.
    pub(crate) fn from_prefix(nodes: Vec<Node>) -> Tree {
        debug_assert_eq!(subtree_end(&nodes, 0), nodes.len());
        Tree { nodes }
    }

    /// The nodes in prefix order, at least one.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Complexity f1: how many nodes, functions and terminals.
    pub fn size(&self) -> usize {
        self.nodes.len()
    }

    /// Depth in edges: 0 for a lone terminal.
    pub fn depth(&self) -> usize {
        self.depths().into_iter().max().unwrap_or(0)
    }

    /// The depth of each node, in edges from the root, in prefix order.
    pub fn depths(&self) -> Vec<usize> {
        let mut open: Vec<usize> = Vec::new();
        let mut depths = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            depths.push(open.len());
            open.push(node.children());
            while open.last() == Some(&0) {
                open.pop();
                if let Some(missing) = open.last_mut() {
                    *missing -= 1;
                }
            }
        }
        depths
    }

    /// Where the subtree rooted at `index` lies in prefix order.
    pub fn subtree(&self, index: usize) -> Range<usize> {
        index..subtree_end(&self.nodes, index)
    }

    /// The tree with the subtree at `index` replaced.
    #[must_use]
    pub fn with_subtree(&self, index: usize, replacement: &[Node]) -> Tree {
        let hole = self.subtree(index);
        let (before, after) = (&self.nodes[..hole.start], &self.nodes[hole.end..]);
        Tree::from_prefix([before, replacement, after].concat())
    }

    /// The symbols in prefix order: equal for trees of equal structure.
    pub fn structure(&self) -> Vec<Symbol> {
        self.nodes.iter().map(|node| node.symbol()).collect()
    }

    /// θ of each motif, in prefix order.
    pub fn thetas(&self) -> Vec<f64> {
        self.nodes
            .iter()
            .filter_map(|node| if let Node::Motif(_, theta) = node { Some(*theta) } else { None })
            .collect()
    }

    /// The same structure with other θ, in prefix order; surplus θ are ignored, missing ones leave the old.
    #[must_use]
    pub fn with_thetas(&self, thetas: &[f64]) -> Tree {
        let mut thetas = thetas.iter();
        let nodes = self.nodes.iter().map(|&node| match node {
            Node::Motif(motif, old) => Node::Motif(motif, thetas.next().copied().unwrap_or(old)),
            terminal => terminal,
        });
        Tree { nodes: nodes.collect() }
    }

    /// The tree in the one [notation].
    pub fn expression(&self, digits: Digits) -> String {
        let part = |node: &Node| match *node {
            Node::Terminal(input) => Part::Input(input),
            Node::Motif(motif, theta) => Part::Motif(motif, theta, node.children()),
        };
        notation::expression(self.nodes.iter().map(part), digits)
    }

    /// The network that computes the tree, one gene per motif node, sigmoid steepness k. A gene reads its operands in
    /// the order of the tree, and the root is the last gene. θ is rounded to `f32`, as robots store it.
    ///
    /// # Errors
    /// A lone terminal ([`NetworkError::Empty`]), too many motifs, θ or k out of range.
    pub fn network(&self, steepness: f32) -> Result<Network<f32, DEFAULT_GENES>, NetworkError> {
        let mut genes = Vec::new();
        self.emit(&mut 0, &mut genes);
        Network::new(steepness, genes)
    }

    /// Appends the genes of the subtree at `*position` in postfix order, and moves behind it.
    fn emit(&self, position: &mut usize, genes: &mut Vec<Gene<f32>>) -> Source {
        let node = self.nodes[*position];
        *position += 1;
        match node {
            Node::Terminal(Terminal::X1) => Source::X1,
            Node::Terminal(Terminal::X2) => Source::X2,
            Node::Motif(motif, theta) => {
                let inputs = (0..children_of(motif)).map(|_| self.emit(position, genes)).collect();
                genes.push(Gene { motif, inputs, theta: theta as f32 });
                Source::Gene(u8::try_from(genes.len() - 1).unwrap_or(u8::MAX))
            }
        }
    }
}

fn subtree_end(nodes: &[Node], start: usize) -> usize {
    let mut missing = 1;
    let mut end = start;
    while missing > 0 {
        missing = missing + nodes[end].children() - 1;
        end += 1;
    }
    end
}

/// The tree in the one [notation], with all digits of θ.
impl fmt::Display for Tree {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.expression(Digits::All))
    }
}

impl From<Tree> for String {
    fn from(tree: Tree) -> String {
        tree.to_string()
    }
}

/// Text is not a syntax tree in prefix notation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParseTreeError(String);

impl fmt::Display for ParseTreeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "not a syntax tree like \"(XNOR[0.9256] (NAND[0.8393] x1 x1) x2)\": {}", self.0)
    }
}

impl std::error::Error for ParseTreeError {}

impl TryFrom<String> for Tree {
    type Error = ParseTreeError;
    fn try_from(text: String) -> Result<Tree, ParseTreeError> {
        text.parse()
    }
}

impl std::str::FromStr for Tree {
    type Err = ParseTreeError;

    fn from_str(text: &str) -> Result<Tree, ParseTreeError> {
        let fault = |what: String| ParseTreeError(what);
        let spaced = text.replace('(', " ( ").replace(')', " ) ");
        let mut nodes = Vec::new();
        // For each open bracket: the position of its motif, if read, and how many operands followed.
        let mut open: Vec<Option<(Motif, usize)>> = Vec::new();
        for word in spaced.split_whitespace() {
            match word {
                "(" => open.push(None),
                ")" => match open.pop() {
                    Some(Some((motif, operands))) if operands == children_of(motif) => {
                        if let Some(Some((_, count))) = open.last_mut() {
                            *count += 1;
                        }
                    }
                    Some(Some((motif, operands))) => {
                        return Err(fault(format!("{} has {operands} operands", motif.name())));
                    }
                    _ => return Err(fault("a bracket closes nothing".into())),
                },
                _ if let Some(input) = notation::input_of(word) => {
                    nodes.push(Node::Terminal(input));
                    if let Some(Some((_, count))) = open.last_mut() {
                        *count += 1;
                    }
                }
                _ => {
                    let node = notation::parse_motif(word).ok_or_else(|| fault(format!("{word:?} is no motif")))?;
                    let slot = open.last_mut().ok_or_else(|| fault(format!("{word:?} stands outside brackets")))?;
                    if slot.is_some() {
                        return Err(fault(format!("{word:?} stands where an operand should")));
                    }
                    *slot = Some((node.0, 0));
                    nodes.push(Node::Motif(node.0, node.1));
                }
            }
        }
        let one_tree = !nodes.is_empty()
            && open.is_empty()
            && nodes.iter().map(|node| node.children()).sum::<usize>() + 1 == nodes.len();
        if one_tree { Ok(Tree { nodes }) } else { Err(fault("it is not exactly one closed expression".into())) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINT_B: &str = "(XNOR[0.2414] (ANDN[1.5441] x2 x1) (NAND[0.0904] x1 x1))";

    #[test]
    fn text_and_tree_are_the_same() {
        let tree: Tree = POINT_B.parse().unwrap();
        assert_eq!(tree.to_string(), POINT_B);
        assert_eq!((tree.size(), tree.depth()), (7, 2));
        assert_eq!(tree.depths(), [0, 1, 2, 2, 1, 2, 2]);
        assert_eq!(tree.thetas(), [0.2414, 1.5441, 0.0904]);
        assert_eq!(tree.with_thetas(&[1.0, 0.5, 0.25]).thetas(), [1.0, 0.5, 0.25]);
        assert_eq!("x1".parse::<Tree>().unwrap().to_string(), "x1");
    }

    #[test]
    fn bad_text_is_refused_with_the_reason() {
        for (text, reason) in [
            ("", "exactly one"),
            ("x1 x2", "exactly one"),
            ("(POS[1] x1", "exactly one"),
            ("(POS[1] x1 x1)", "POS has 2 operands"),
            ("(AND[1] x1)", "AND has 1 operands"),
            ("(MAYBE[1] x1)", "MAYBE[1]"),
            ("(POS x1)", "\"POS\""),
            ("(POS[NaN] x1)", "NaN"),
            (")", "closes nothing"),
            ("(POS[1] (x1))", "closes nothing"),
        ] {
            let error = text.parse::<Tree>().unwrap_err().to_string();
            assert!(error.contains(reason), "{text:?}: {error}");
        }
    }

    #[test]
    fn genes_come_in_postfix_order() {
        let network = POINT_B.parse::<Tree>().unwrap().network(1.0).unwrap();
        let motifs: Vec<_> = network.genes().iter().map(|gene| gene.motif).collect();
        assert_eq!(motifs, [Motif::Andn, Motif::Nand, Motif::Xnor]);
        assert_eq!(network.genes()[0].inputs, [Source::X2, Source::X1]);
        assert_eq!(network.genes()[2].inputs, [Source::Gene(0), Source::Gene(1)]);
        assert!(Tree::from_prefix(vec![Node::Terminal(Terminal::X1)]).network(1.0).is_err());
    }

    #[test]
    fn a_subtree_is_replaced() {
        let tree: Tree = POINT_B.parse().unwrap();
        assert_eq!(tree.subtree(1), 1..4);
        let cut = tree.with_subtree(1, &[Node::Terminal(Terminal::X2)]);
        assert_eq!(cut.to_string(), "(XNOR[0.2414] x2 (NAND[0.0904] x1 x1))");
    }
}
