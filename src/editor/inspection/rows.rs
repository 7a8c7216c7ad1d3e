//! The table of edges: filtered and sorted, made again only when something it depends on changed.

use std::cmp::Ordering;

use bevy::prelude::*;

use super::{Findings, InspectionChoices};
use crate::editor::object::FacePlace;
use crate::editor::selection::Selection;
use crate::inspect::{Edge, EdgeKey, EdgeKind, GapSense};

/// One edge in the table.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The edge.
    pub key: EdgeKey,
    /// What it is.
    pub kind: EdgeKind,
    /// Numbers of its faces in their models, from 1.
    pub faces: Vec<usize>,
    /// Largest gap, millimetres; none for naked edges.
    pub gap: Option<f64>,
    /// Mean gap, millimetres.
    pub mean: Option<f64>,
    /// How the sides lie to each other where the gap is largest.
    pub sense: Option<GapSense>,
    /// Length, millimetres.
    pub length: f64,
    /// Largest angle between the tangent planes, radians.
    pub angle: Option<f64>,
}

/// Which edges are shown.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Filter {
    /// Only gaps above the tolerance (and edges without a gap).
    pub defects_only: bool,
    /// Edges of two faces, and seams.
    pub shared: bool,
    /// Edges of one face.
    pub naked: bool,
    /// Edges of three faces or more.
    pub non_manifold: bool,
    /// Only edges of selected faces.
    pub selected_only: bool,
    /// Only edges of the face with this number, when it is one.
    pub text: String,
}

impl Default for Filter {
    fn default() -> Self {
        Self {
            defects_only: false,
            shared: true,
            naked: true,
            non_manifold: true,
            selected_only: false,
            text: String::new(),
        }
    }
}

/// What the table can be sorted by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Column {
    Kind,
    Faces,
    Gap,
    Mean,
    Sense,
    Length,
    Angle,
}

/// How the table is sorted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Order {
    /// By this.
    pub column: Column,
    /// Largest first.
    pub descending: bool,
}

impl Default for Order {
    fn default() -> Self {
        Self { column: Column::Gap, descending: true }
    }
}

/// The rows shown.
#[derive(Resource, Debug, Default)]
pub struct Rows {
    /// In the order shown.
    pub rows: Vec<Row>,
    /// Counts how often they were made.
    pub revision: u64,
    made_from: Option<(u64, u64, InspectionChoices)>,
}

/// Makes the rows again if findings, choices or (when it matters) the selection changed.
pub(super) fn update(
    findings: Res<Findings>,
    choices: Res<InspectionChoices>,
    selection: Res<Selection>,
    places: Query<&FacePlace>,
    mut rows: ResMut<Rows>,
) {
    let selected = if choices.filter.selected_only { selection.revision } else { 0 };
    let key = (findings.revision, selected, choices.clone());
    if rows.made_from.as_ref() == Some(&key) {
        return;
    }
    rows.made_from = Some(key);
    rows.revision += 1;
    rows.rows.clear();
    let Some(inspection) = findings.inspection() else { return };
    let number = |face: usize| {
        let entity = findings.face(face)?;
        places.get(entity).ok().map(|p| p.number)
    };
    let is_selected = |edge: &Edge| {
        edge.faces().iter().any(|f| findings.face(*f).is_some_and(|entity| selection.contains(entity)))
    };
    let made = inspection
        .edges()
        .filter(|(_, edge)| !choices.filter.selected_only || is_selected(edge))
        .map(|(key, edge)| Row::of(*key, edge, findings.unit(), number))
        .filter(|row| choices.filter.passes(row, choices.tolerance));
    let made: Vec<Row> = made.collect();
    rows.rows = made;
    let order = choices.order;
    rows.rows.sort_by(|a, b| order.compare(a, b).then_with(|| a.key.cmp(&b.key)));
}

impl Row {
    fn of(key: EdgeKey, edge: &Edge, unit: f64, number: impl Fn(usize) -> Option<usize>) -> Self {
        Self {
            key,
            kind: edge.kind,
            faces: edge.faces().into_iter().filter_map(number).collect(),
            gap: edge.gap.map(|g| unit * g.maximum),
            mean: edge.gap.map(|g| unit * g.mean),
            sense: edge.gap.map(|g| g.sense),
            length: unit * edge.length(),
            angle: edge.gap.map(|g| g.angle),
        }
    }

    /// Whether the edge is something to look at: a gap above the tolerance, naked or non-manifold.
    pub fn is_defect(&self, tolerance: f64) -> bool {
        match self.kind {
            EdgeKind::Naked | EdgeKind::NonManifold => true,
            EdgeKind::Shared | EdgeKind::Seam => self.gap.is_some_and(|g| g > tolerance),
            EdgeKind::Degenerate => false,
        }
    }
}

impl Filter {
    /// Whether a row is shown.
    pub fn passes(&self, row: &Row, tolerance: f64) -> bool {
        let kind = match row.kind {
            EdgeKind::Shared | EdgeKind::Seam => self.shared,
            EdgeKind::Naked => self.naked,
            EdgeKind::NonManifold => self.non_manifold,
            EdgeKind::Degenerate => false,
        };
        let text = self.text.trim();
        let about = text.is_empty() || row.faces.iter().any(|n| n.to_string() == text);
        kind && about && (!self.defects_only || row.is_defect(tolerance))
    }
}

impl Order {
    /// The order of two rows; edges without a figure come last either way.
    pub fn compare(&self, a: &Row, b: &Row) -> Ordering {
        let figures = |x: Option<f64>, y: Option<f64>| match (x, y) {
            (Some(x), Some(y)) => self.turn(x.total_cmp(&y)),
            (Some(_), None) => Ordering::Less,
            (None, Some(_)) => Ordering::Greater,
            (None, None) => Ordering::Equal,
        };
        match self.column {
            Column::Kind => self.turn(a.kind.cmp(&b.kind)),
            Column::Faces => self.turn(a.faces.cmp(&b.faces)),
            Column::Gap => figures(a.gap, b.gap),
            Column::Mean => figures(a.mean, b.mean),
            Column::Sense => self.turn(a.sense.cmp(&b.sense)),
            Column::Length => figures(Some(a.length), Some(b.length)),
            Column::Angle => figures(a.angle, b.angle),
        }
    }

    fn turn(&self, ordering: Ordering) -> Ordering {
        if self.descending { ordering.reverse() } else { ordering }
    }

    /// After a click on the head of a column: the other direction, or the new column's natural one.
    pub fn clicked(self, column: Column) -> Self {
        if column == self.column {
            return Self { descending: !self.descending, ..self };
        }
        let descending = !matches!(column, Column::Kind | Column::Faces);
        Self { column, descending }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inspect::CurveAddress;

    fn row(face: usize, kind: EdgeKind, gap: Option<f64>) -> Row {
        let curve = CurveAddress { face, trim_loop: 0, curve: 0 };
        let key = EdgeKey { curve, position: 0 };
        let faces = vec![face + 1];
        Row { key, kind, faces, gap, mean: gap, sense: None, length: 1.0, angle: None }
    }

    #[test]
    fn edges_without_a_gap_come_last_either_way() {
        let mut rows = [
            row(0, EdgeKind::Naked, None),
            row(1, EdgeKind::Shared, Some(1e-3)),
            row(2, EdgeKind::Shared, Some(0.5)),
        ];
        let order = Order::default();
        rows.sort_by(|a, b| order.compare(a, b));
        assert_eq!(rows.iter().map(|r| r.faces[0]).collect::<Vec<_>>(), [3, 2, 1]);
        let order = order.clicked(Column::Gap);
        rows.sort_by(|a, b| order.compare(a, b));
        assert_eq!(rows.iter().map(|r| r.faces[0]).collect::<Vec<_>>(), [2, 3, 1]);
    }

    #[test]
    fn the_filter_knows_kinds_tolerance_and_face_numbers() {
        let naked = row(0, EdgeKind::Naked, None);
        let small = row(1, EdgeKind::Shared, Some(1e-4));
        let large = row(2, EdgeKind::Shared, Some(1.0));
        let shown =
            |filter: &Filter| [&naked, &small, &large].into_iter().filter(|r| filter.passes(r, 0.01)).count();
        assert_eq!(shown(&Filter::default()), 3);
        assert_eq!(shown(&Filter { defects_only: true, ..Filter::default() }), 2);
        assert_eq!(shown(&Filter { naked: false, ..Filter::default() }), 2);
        assert_eq!(shown(&Filter { text: " 3 ".into(), ..Filter::default() }), 1);
        assert_eq!(shown(&Filter { text: "33".into(), ..Filter::default() }), 0);
    }
}
