//! A model's pattern error tabulated over its two inputs, for deciding which lattice nodes are inside.

use super::lanes::{Lanes, WIDTH};
use super::model::Model;

/// Divisions of the unit interval of x1 and x2 on the coarsest table; x1 runs from 0 to the number of targets.
const X1_DIVISIONS: usize = 32;
const X2_DIVISIONS: usize = 16;
/// How many times finer a table may be.
const FINENESS: [usize; 2] = [1, 2];

/// A table's accuracy is an estimate: a sign is certain this many times farther from zero.
const MARGIN: f64 = 1.5;

/// φ at a grid of (x1, x2), between which it is interpolated linearly.
#[derive(Clone, Debug)]
pub(super) struct ErrorTable {
    /// Divisions of the unit interval of x1 and x2.
    divisions: [f64; 2],
    columns: usize,
    errors: Vec<f64>,
    accuracy: f64,
}

impl ErrorTable {
    /// The table of a model for x1 up to `targets`, so fine that it is off by less than `tolerance`, if that is possible.
    pub(super) fn of(model: &Model, targets: usize, tolerance: f64) -> Option<ErrorTable> {
        let mut tables = FINENESS.into_iter().map(|fineness| ErrorTable::drawn(fineness, model, targets));
        tables.find(|table| table.accuracy < tolerance)
    }

    fn drawn(fineness: usize, model: &Model, targets: usize) -> ErrorTable {
        let (x1_divisions, x2_divisions) = (X1_DIVISIONS * fineness, X2_DIVISIONS * fineness);
        let divisions = [x1_divisions as f64, x2_divisions as f64];
        let [per_x1, per_x2] = divisions.map(|divisions| 1.0 / divisions);
        // One column and one row more than needed, so that the last cell has a far side.
        let (columns, rows) = ((targets * x1_divisions + 2).next_multiple_of(WIDTH), x2_divisions + 2);
        let mut errors = Vec::with_capacity(columns * rows);
        for row in 0..rows {
            let x2 = Lanes::splat(row as f64 * per_x2);
            for first in (0..columns).step_by(WIDTH) {
                let x1 = Lanes(std::array::from_fn(|lane| (first + lane) as f64 * per_x1));
                errors.extend(model.errors(x1, x2).0);
            }
        }
        let mut table = ErrorTable { divisions, columns, errors, accuracy: 0.0 };
        table.accuracy = table.largest_second_difference() / 8.0;
        table
    }

    fn largest_second_difference(&self) -> f64 {
        let errors = &self.errors;
        let largest = |stride: usize| {
            let triples =
                (stride..errors.len() - stride).map(|i| errors[i - stride] + errors[i + stride] - 2.0 * errors[i]);
            triples.fold(0.0_f64, |largest, difference| largest.max(difference.abs()))
        };
        let along_rows = errors.chunks(self.columns).flat_map(|row| row.windows(3));
        let along_rows = along_rows.fold(0.0_f64, |most, w| most.max((w[0] + w[2] - 2.0 * w[1]).abs()));
        along_rows + largest(self.columns)
    }

    /// φ at (x1, x2) in the charted range, by bilinear interpolation.
    #[inline]
    pub(super) fn at(&self, x1: f64, x2: f64) -> f64 {
        let (east, north) = (x1 * self.divisions[0], x2 * self.divisions[1]);
        let (column, row) = (east as u32 as usize, north as u32 as usize);
        let (t, u) = (east - column as f64, north - row as f64);
        let corner = row * self.columns + column;
        let near = &self.errors[corner..corner + 2];
        let far = &self.errors[corner + self.columns..corner + self.columns + 2];
        let (below, above) = (near[0] + (near[1] - near[0]) * t, far[0] + (far[1] - far[0]) * t);
        below + (above - below) * u
    }

    /// φ at eight places, if its sign is certain at all of them.
    pub(super) fn sure_at(&self, x1: Lanes, x2: Lanes) -> Option<Lanes> {
        let errors = Lanes(std::array::from_fn(|lane| self.at(x1.0[lane], x2.0[lane])));
        errors.0.iter().all(|error| error.abs() > MARGIN * self.accuracy).then_some(errors)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::published::PUBLISHED;

    #[test]
    fn the_chart_keeps_its_promised_accuracy() {
        for published in &PUBLISHED {
            let model = Model::new(&published.network().unwrap(), 0.5).unwrap();
            let table = ErrorTable::of(&model, 2, 0.005).unwrap_or_else(|| panic!("{}", published.name));
            for i in 0..=200 {
                for j in 0..=100 {
                    let (x1, x2) = (f64::from(i) * 0.01, f64::from(j) * 0.01);
                    let error = (table.at(x1, x2) - model.error(x1, x2)).abs();
                    assert!(error <= 1.1 * table.accuracy, "{}: off by {error}", published.name);
                }
            }
        }
    }
}
