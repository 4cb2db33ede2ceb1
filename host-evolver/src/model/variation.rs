//! How trees are created and varied: ramped half-and-half, subtree crossover, subtree mutation.

use super::notation::Terminal;
use super::tree::{Node, Tree, children_of};
use grn_core::motif::Motif;
use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};

/// Koza's bias: crossover prefers inner nodes to leaves this often.
const INNER_NODE_BIAS: f64 = 0.9;

/// Which motifs evolution may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MotifSet {
    /// All ten.
    All,
    /// The eight with two inputs, which give trees of 3, 5, 7, … nodes as in the paper's fronts.
    Binary,
}

impl MotifSet {
    /// The motifs, in the order of their opcodes.
    pub fn motifs(self) -> Vec<Motif> {
        Motif::ALL.into_iter().filter(|&motif| self == MotifSet::All || children_of(motif) == 2).collect()
    }
}

/// What trees may read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Inputs {
    /// x1 and x2.
    #[default]
    Both,
    /// x1 alone: the models are blind to obstacles, and around a lone target every pattern is a circle.
    Targets,
}

impl Inputs {
    fn terminals(self) -> &'static [Terminal] {
        match self {
            Inputs::Both => &[Terminal::X1, Terminal::X2],
            Inputs::Targets => &[Terminal::X1],
        }
    }
}

/// How trees are created and varied. Every call uses only the given random numbers, so equal seeds give equal trees.
pub trait Variation: Send + Sync {
    /// Individual number `place` of an initial population.
    fn create(&self, place: usize, rng: &mut dyn Rng) -> Tree;
    /// A child of two trees; θ come along with their nodes.
    fn cross(&self, mother: &Tree, father: &Tree, rng: &mut dyn Rng) -> Tree;
    /// A changed tree.
    fn mutate(&self, tree: &Tree, rng: &mut dyn Rng) -> Tree;
}

/// The space of trees: which motifs, how deep, which θ.
#[derive(Clone, Debug)]
pub struct Grammar {
    motifs: Vec<Motif>,
    terminals: &'static [Terminal],
    depth: (usize, usize),
    theta: (f64, f64),
}

impl Grammar {
    /// Trees of the given motifs with depth (in edges) and θ in the given inclusive ranges; least depth 1.
    pub fn new(motifs: MotifSet, depth: (usize, usize), theta: (f64, f64)) -> Grammar {
        let depth = (depth.0.max(1), depth.1.max(depth.0).max(1));
        Grammar { motifs: motifs.motifs(), terminals: Inputs::Both.terminals(), depth, theta }
    }

    /// The same for trees that read no more than this.
    #[must_use]
    pub fn reading(self, inputs: Inputs) -> Grammar {
        Grammar { terminals: inputs.terminals(), ..self }
    }

    /// A random tree of at most `depth` edges, with a motif at its root; full trees have all leaves at that depth.
    pub fn random(&self, depth: usize, full: bool, rng: &mut impl Rng) -> Tree {
        let mut nodes = Vec::new();
        self.grow(depth, full, true, rng, &mut nodes);
        Tree::from_prefix(nodes)
    }

    fn grow(&self, depth: usize, full: bool, root: bool, rng: &mut impl Rng, nodes: &mut Vec<Node>) {
        let symbols = self.motifs.len() + self.terminals.len();
        let inner = depth > 0 && (full || root || rng.random_range(0..symbols) < self.motifs.len());
        if !inner {
            nodes.push(Node::Terminal(self.terminals[rng.random_range(0..self.terminals.len())]));
            return;
        }
        let motif = self.motifs[rng.random_range(0..self.motifs.len())];
        nodes.push(Node::Motif(motif, rng.random_range(self.theta.0..=self.theta.1)));
        for _ in 0..children_of(motif) {
            self.grow(depth - 1, full, false, rng, nodes);
        }
    }
}

impl Variation for Grammar {
    /// Ramped half-and-half: depths cycle through their range, and full and grown trees alternate.
    fn create(&self, place: usize, mut rng: &mut dyn Rng) -> Tree {
        let (least, most) = self.depth;
        let ramp = most - least + 1;
        let depth = least + (place / 2) % ramp;
        self.random(depth, place.is_multiple_of(2), &mut rng)
    }

    /// Subtree crossover: a subtree of `mother` is replaced by one of `father` that keeps the child within the depth
    /// range.
    fn cross(&self, mother: &Tree, father: &Tree, mut rng: &mut dyn Rng) -> Tree {
        let point = pick(mother, |_| true, &mut rng).unwrap_or(0);
        let room = self.depth.1 - mother.depths()[point];
        let heights = heights(father);
        let fits = |index: usize| {
            let height = heights[index];
            height <= room && (point > 0 || height >= self.depth.0)
        };
        match pick(father, fits, &mut rng) {
            Some(donor) => mother.with_subtree(point, &father.nodes()[father.subtree(donor)]),
            None => mother.clone(),
        }
    }

    /// Subtree mutation: a random subtree is replaced by a freshly grown one that fits.
    fn mutate(&self, tree: &Tree, mut rng: &mut dyn Rng) -> Tree {
        let point = rng.random_range(0..tree.size());
        let room = self.depth.1 - tree.depths()[point];
        let mut nodes = Vec::new();
        self.grow(room, false, point == 0, &mut rng, &mut nodes);
        tree.with_subtree(point, &nodes)
    }
}

/// No variation at all: every tree is drawn anew. A search with it is a random search.
#[derive(Clone, Debug)]
pub struct Afresh(pub Grammar);

impl Variation for Afresh {
    fn create(&self, place: usize, rng: &mut dyn Rng) -> Tree {
        self.0.create(place, rng)
    }

    fn cross(&self, _: &Tree, _: &Tree, mut rng: &mut dyn Rng) -> Tree {
        let place = rng.random_range(0..PLACES);
        self.0.create(place, &mut rng)
    }

    fn mutate(&self, tree: &Tree, _: &mut dyn Rng) -> Tree {
        tree.clone()
    }
}

/// Ramped half-and-half repeats itself after so many places, for every greatest depth that is possible.
const PLACES: usize = 24;

/// A node of `tree` among those that fit, inner nodes with [`INNER_NODE_BIAS`]; `None` if none fits.
fn pick(tree: &Tree, fits: impl Fn(usize) -> bool, rng: &mut impl Rng) -> Option<usize> {
    let fitting = (0..tree.size()).filter(|&index| fits(index));
    let (inner, leaves): (Vec<_>, Vec<_>) = fitting.partition(|&index| tree.nodes()[index].children() > 0);
    let prefer_inner = rng.random_bool(INNER_NODE_BIAS);
    let pool = if leaves.is_empty() || (prefer_inner && !inner.is_empty()) { inner } else { leaves };
    (!pool.is_empty()).then(|| pool[rng.random_range(0..pool.len())])
}

/// The height of the subtree at each node, in edges.
fn heights(tree: &Tree) -> Vec<usize> {
    let depths = tree.depths();
    let deepest = |index: usize| depths[tree.subtree(index)].iter().copied().max().unwrap_or(0);
    (0..tree.size()).map(|index| deepest(index) - depths[index]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    fn grammar(set: MotifSet) -> Grammar {
        Grammar::new(set, (1, 4), (0.0, 2.0))
    }

    #[test]
    fn ramped_trees_cover_the_depths_and_full_ones_are_full() {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let trees: Vec<_> = (0..40).map(|i| grammar(MotifSet::Binary).create(i, &mut rng)).collect();
        for (index, tree) in trees.iter().enumerate() {
            let aim = 1 + (index / 2) % 4;
            assert!((1..=aim).contains(&tree.depth()));
            if index % 2 == 0 {
                assert_eq!((tree.depth(), tree.size()), (aim, (2 << aim) - 1));
            }
        }
    }

    #[test]
    fn offspring_stay_in_the_grammar() {
        let grammar = grammar(MotifSet::All);
        let mut rng = ChaCha8Rng::seed_from_u64(2);
        let mut trees: Vec<_> = (0..40).map(|i| grammar.create(i, &mut rng)).collect();
        let mut changed = 0;
        for round in 0..5000 {
            let (a, b) = (rng.random_range(0..40), rng.random_range(0..40));
            let crossed = grammar.cross(&trees[a], &trees[b], &mut rng);
            let child = if round % 10 == 0 { grammar.mutate(&crossed, &mut rng) } else { crossed };
            assert!((1..=4).contains(&child.depth()), "{child}");
            assert!(child.thetas().iter().all(|theta| (0.0..=2.0).contains(theta)));
            assert!(child.network(1.0).is_ok(), "{child}");
            changed += usize::from(child.structure() != trees[a].structure());
            trees[a] = child;
        }
        assert!(changed > 2500, "crossover changed only {changed} of 5000 trees");
    }

    #[test]
    fn blind_trees_read_targets_only() {
        let grammar = grammar(MotifSet::All).reading(Inputs::Targets);
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let reads = |tree: &Tree, input| tree.nodes().contains(&Node::Terminal(input));
        for place in 0..200 {
            let tree = grammar.create(place, &mut rng);
            let child = grammar.mutate(&Afresh(grammar.clone()).cross(&tree, &tree, &mut rng), &mut rng);
            assert!(reads(&child, Terminal::X1) && !reads(&tree, Terminal::X2) && !reads(&child, Terminal::X2));
        }
    }

    #[test]
    fn binary_trees_have_odd_sizes() {
        let grammar = grammar(MotifSet::Binary);
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        assert!((0..200).all(|i| grammar.create(i, &mut rng).size() % 2 == 1));
    }
}
