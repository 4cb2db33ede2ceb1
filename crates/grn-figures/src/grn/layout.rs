//! Where the genes of a network stand: layers from left to right, few crossings, and an empty place in
//! every layer that an edge passes, so that no edge runs through a box (Sugiyama et al. 1981).

/// A node to place: an input, a gene, or a stretch of a long edge.
#[derive(Debug, Clone)]
pub(crate) struct Node {
    pub layer: usize,
    pub height: f64,
    /// Middle, after [`Layout::arrange`].
    pub y: f64,
}

/// Nodes and the links between neighbouring layers.
#[derive(Debug, Default)]
pub(crate) struct Layout {
    pub nodes: Vec<Node>,
    links: Vec<(usize, usize)>,
    order: Vec<Vec<usize>>,
}

/// Free space between two nodes of a layer, points.
const SPACE: f64 = 9.0;

impl Layout {
    pub fn add(&mut self, layer: usize, height: f64) -> usize {
        self.nodes.push(Node { layer, height, y: 0.0 });
        self.nodes.len() - 1
    }

    /// Connects two nodes; returns the places in the layers between them.
    pub fn connect(&mut self, from: usize, to: usize) -> Vec<usize> {
        let (mut last, mut passed) = (from, Vec::new());
        for layer in self.nodes[from].layer + 1..self.nodes[to].layer {
            let place = self.add(layer, 1.0);
            self.links.push((last, place));
            passed.push(place);
            last = place;
        }
        self.links.push((last, to));
        passed
    }

    /// Orders every layer and sets every `y`; returns the total height, from 0.
    pub fn arrange(&mut self) -> f64 {
        let layers = self.nodes.iter().map(|n| n.layer + 1).max().unwrap_or(0);
        self.order = vec![Vec::new(); layers];
        for (i, node) in self.nodes.iter().enumerate() {
            self.order[node.layer].push(i);
        }
        let mut best = (self.crossings(), self.order.clone());
        for sweep in 0..24 {
            let forwards = sweep % 2 == 0;
            for step in 0..layers {
                self.sort_layer(if forwards { step } else { layers - 1 - step }, forwards);
            }
            let crossings = self.crossings();
            if crossings < best.0 {
                best = (crossings, self.order.clone());
            }
        }
        self.order = best.1;
        self.settle()
    }

    fn rank(&self) -> Vec<f64> {
        let mut rank = vec![0.0; self.nodes.len()];
        for layer in &self.order {
            for (i, &node) in layer.iter().enumerate() {
                rank[node] = (i as f64 + 0.5) / layer.len() as f64;
            }
        }
        rank
    }

    /// Sorts a layer by the mean rank of its neighbours on one side; nodes without any keep theirs.
    fn sort_layer(&mut self, layer: usize, forwards: bool) {
        let rank = self.rank();
        let mean = |node: usize| {
            let near = |&(a, b): &(usize, usize)| match forwards {
                true => (b == node).then_some(rank[a]),
                false => (a == node).then_some(rank[b]),
            };
            let ranks: Vec<f64> = self.links.iter().filter_map(near).collect();
            if ranks.is_empty() { rank[node] } else { ranks.iter().sum::<f64>() / ranks.len() as f64 }
        };
        let mut keyed: Vec<(f64, usize)> = self.order[layer].iter().map(|&n| (mean(n), n)).collect();
        keyed.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.order[layer] = keyed.into_iter().map(|(_, node)| node).collect();
    }

    fn crossings(&self) -> usize {
        let rank = self.rank();
        let mut count = 0;
        for (i, a) in self.links.iter().enumerate() {
            for b in &self.links[i + 1..] {
                let same_layer = self.nodes[a.0].layer == self.nodes[b.0].layer;
                if same_layer && (rank[a.0] - rank[b.0]) * (rank[a.1] - rank[b.1]) < 0.0 {
                    count += 1;
                }
            }
        }
        count
    }

    /// Draws every node towards the mean of its neighbours, keeping order and distances.
    fn settle(&mut self) -> f64 {
        for layer in &self.order {
            let mut y = 0.0;
            for &node in layer {
                self.nodes[node].y = y + self.nodes[node].height / 2.0;
                y += self.nodes[node].height + SPACE;
            }
            for &node in layer {
                self.nodes[node].y -= y / 2.0;
            }
        }
        for round in 0..60 {
            for step in 0..self.order.len() {
                let at = if round % 2 == 0 { step } else { self.order.len() - 1 - step };
                self.settle_layer(&self.order[at].clone());
            }
        }
        let top = self.nodes.iter().map(|n| n.y - n.height / 2.0).fold(f64::INFINITY, f64::min);
        let bottom = self.nodes.iter().map(|n| n.y + n.height / 2.0).fold(f64::NEG_INFINITY, f64::max);
        for node in &mut self.nodes {
            node.y -= top;
        }
        (bottom - top).max(0.0)
    }

    fn settle_layer(&mut self, layer: &[usize]) {
        let wish = |node: usize| {
            let near = self.links.iter().filter_map(|&(a, b)| match (a == node, b == node) {
                (true, _) => Some(self.nodes[b].y),
                (_, true) => Some(self.nodes[a].y),
                _ => None,
            });
            let (sum, count) = near.fold((0.0, 0.0), |(sum, count), y| (sum + y, count + 1.0));
            if count > 0.0 { sum / count } else { self.nodes[node].y }
        };
        let apart = |a: usize, b: usize| (self.nodes[a].height + self.nodes[b].height) / 2.0 + SPACE;
        let wishes: Vec<f64> = layer.iter().map(|&n| wish(n)).collect();
        let (mut down, mut up) = (wishes.clone(), wishes);
        for i in 1..layer.len() {
            down[i] = down[i].max(down[i - 1] + apart(layer[i - 1], layer[i]));
            let j = layer.len() - 1 - i;
            up[j] = up[j].min(up[j + 1] - apart(layer[j], layer[j + 1]));
        }
        for (i, &node) in layer.iter().enumerate() {
            self.nodes[node].y = (down[i] + up[i]) / 2.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_strands_are_untangled_and_apart() {
        let mut layout = Layout::default();
        let (a, b) = (layout.add(0, 20.0), layout.add(0, 20.0));
        let (d, c) = (layout.add(1, 30.0), layout.add(1, 30.0));
        let end = layout.add(2, 30.0);
        layout.connect(a, c);
        layout.connect(b, d);
        layout.connect(c, end);
        layout.connect(d, end);
        let passed = layout.connect(a, end);
        assert_eq!(passed.len(), 1);
        let height = layout.arrange();
        assert_eq!(layout.crossings(), 0);
        for layer in &layout.order {
            for pair in layer.windows(2) {
                let (p, q) = (&layout.nodes[pair[0]], &layout.nodes[pair[1]]);
                assert!(q.y - p.y >= (p.height + q.height) / 2.0 + SPACE - 1e-9);
            }
        }
        assert!(layout.nodes.iter().all(|n| n.y >= 0.0 && n.y <= height));
    }
}
