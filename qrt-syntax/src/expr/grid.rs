//! The values of an expression of u and v at all points of a grid.

use super::{Expr, Variable, Variables};

/// An expression on a grid of the square.
///
/// Parts that depend on u alone are computed once a row, and those that depend on v alone once a column: most maps
/// have all their roots, sines and cosines there. The values are those of [`Expr::eval`].
///
/// ```
/// use qrt_syntax::expr::{Expr, OnGrid, Variable, Variables};
/// let expr = Expr::parse("sqrt(u) * cos(2*pi*v)", &Variable::SQUARE).unwrap();
/// let mut grid = OnGrid::new(&expr, &[0.0, 0.5]);
/// grid.set_u(0.25);
/// let at = Variables { u: 0.25, v: 0.5, ..Variables::default() };
/// assert_eq!(grid.value(1), expr.eval(&at));
/// ```
#[derive(Clone, Debug)]
pub struct OnGrid<'e> {
    expr: &'e Expr,
    /// The nodes to compute in each row, and at each point.
    by_row: Vec<usize>,
    by_point: Vec<usize>,
    /// The nodes that are known by column, and their values: column by column.
    by_column: Vec<usize>,
    columns: Vec<f64>,
    /// Number of columns.
    width: usize,
    /// The values of all nodes at the last point.
    values: Vec<f64>,
}

impl<'e> OnGrid<'e> {
    /// Prepares the columns `v`. Variables other than u and v are 0, and so is u until [`OnGrid::set_u`].
    pub fn new(expr: &'e Expr, v: &[f64]) -> Self {
        let mut grid = Self {
            expr,
            by_row: Vec::new(),
            by_point: Vec::new(),
            by_column: Vec::new(),
            columns: Vec::new(),
            width: v.len(),
            values: vec![0.0; expr.nodes.len()],
        };
        for (node, set) in expr.node_variables().into_iter().enumerate() {
            match [Variable::U, Variable::V].map(|axis| set.contains(axis)) {
                [false, false] => grid.compute(node, &Variables::default()),
                [true, false] => grid.by_row.push(node),
                [false, true] => grid.by_column.push(node),
                [true, true] => grid.by_point.push(node),
            }
        }
        for &v in v {
            let at = Variables {
                v,
                ..Variables::default()
            };
            for place in 0..grid.by_column.len() {
                let node = grid.by_column[place];
                grid.compute(node, &at);
                grid.columns.push(grid.values[node]);
            }
        }
        grid.set_u(0.0);
        grid
    }

    fn compute(&mut self, node: usize, at: &Variables) {
        self.values[node] = self.expr.nodes[node].value(at, |id| self.values[id.index()]);
    }

    /// Goes to the row of `u`.
    pub fn set_u(&mut self, u: f64) {
        let at = Variables {
            u,
            ..Variables::default()
        };
        for place in 0..self.by_row.len() {
            self.compute(self.by_row[place], &at);
        }
    }

    /// Returns the value in a column of the row.
    ///
    /// # Panics
    ///
    /// Panics if there is no such column.
    pub fn value(&mut self, column: usize) -> f64 {
        assert!(column < self.width, "column {column} of {}", self.width);
        let known = &self.columns[column * self.by_column.len()..][..self.by_column.len()];
        for (&node, &value) in self.by_column.iter().zip(known) {
            self.values[node] = value;
        }
        for place in 0..self.by_point.len() {
            self.compute(self.by_point[place], &Variables::default());
        }
        self.values[self.expr.root.index()]
    }

    /// The values of all nodes at the last point, as [`Expr::eval_in`] leaves them.
    pub fn values(&self) -> &[f64] {
        &self.values
    }
}
