//! The prompt for the values of a command: what is asked, what was typed, why it was refused.

use bevy::prelude::*;

use super::operations::{Target, curves_meant};
use crate::editor::tools::EditAction;
use crate::kernel::trim::UvRect;

/// The open prompt, if there is one.
#[derive(Resource, Debug, Default)]
pub struct Prompt {
    open: Option<EditAction>,
    /// One for each field of the action, as typed.
    pub values: Vec<String>,
    refusal: Option<String>,
    /// Whether the first field is still to get the keyboard.
    pub fresh: bool,
}

impl Prompt {
    /// What the prompt is for.
    pub fn action(&self) -> Option<EditAction> {
        self.open
    }

    /// Whether there is a prompt.
    pub fn is_open(&self) -> bool {
        self.open.is_some()
    }

    /// Opens it with values to begin with.
    pub fn open(&mut self, action: EditAction, values: Vec<String>) {
        *self = Self { open: Some(action), values, refusal: None, fresh: true };
    }

    /// Closes it.
    pub fn close(&mut self) {
        *self = Self::default();
    }

    /// Says why the values cannot be used.
    pub fn refuse(&mut self, reason: String) {
        self.refusal = Some(reason);
    }

    /// Why the values could not be used.
    pub fn refusal(&self) -> Option<&str> {
        self.refusal.as_deref()
    }
}

/// Values to begin with: what is there now, or something that makes sense.
pub(super) fn defaults(action: EditAction, target: &Target) -> Vec<String> {
    use EditAction as A;
    let text = |x: f64| format!("{x}");
    let round = |x: f64| format!("{}", (x * 1e6).round() / 1e6);
    let Some((_, record)) = target.face else { return vec![String::new(); action.fields().len()] };
    let domain = UvRect::of_surface(&record.surface);
    let (centre, size) = (0.5 * (domain.min + domain.max), domain.size());
    let curve = curves_meant(target.elements, &record.loops);
    let curve = curve.first().and_then(|(l, c)| record.loops.get(*l)?.curves.get(*c));
    let point = target.elements.points(&record.loops);
    let point = point.first().and_then(|(l, c, p)| {
        let curve = record.loops.get(*l)?.curves.get(*c)?;
        Some((*curve.points().get(*p)?, *curve.weights().get(*p)?))
    });
    let net = target.elements.surface_points();
    let net_weight = net.first().and_then(|k| record.surface.weights().get(*k).copied());
    match action {
        A::AddRectangle => {
            let (a, b) = (centre - 0.1 * size, centre + 0.1 * size);
            [a.x, a.y, b.x, b.y].map(round).to_vec()
        }
        A::AddCircle => [centre.x, centre.y, 0.1 * size.min_element()].map(round).to_vec(),
        A::AddEllipse => [centre.x, centre.y, 0.15 * size.x, 0.1 * size.y, 0.0].map(round).to_vec(),
        A::AddPolyline => {
            let corners = [(-0.1, -0.1), (0.1, -0.1), (0.0, 0.1)];
            let corner = |(u, v): (f64, f64)| {
                format!("{} {}", round(centre.x + u * size.x), round(centre.y + v * size.y))
            };
            vec![corners.map(corner).join(", ")]
        }
        A::AddText => {
            let mut values = vec!["HAIRLINE".to_owned()];
            values.extend([centre.x, centre.y, 0.1 * size.y].map(round));
            values
        }
        A::Rotate => vec!["90".into()],
        A::Scale => vec!["2".into(), "2".into()],
        A::SetPoint => point.map_or(vec![String::new(); 2], |(p, _)| vec![text(p.x), text(p.y)]),
        A::SetWeight => vec![text(point.map(|p| p.1).or(net_weight).unwrap_or(1.0))],
        A::InsertKnot | A::Split => {
            // The middle of the longest span: a knot there is a new one.
            let breaks = curve.map_or(vec![0.0, 1.0], |c| c.knots().breaks());
            let spans = breaks.windows(2).map(|s| (s[1] - s[0], 0.5 * (s[0] + s[1])));
            let longest = spans.max_by(|a, b| a.0.total_cmp(&b.0));
            vec![text(longest.map_or(0.5, |(_, middle)| middle))]
        }
        A::RemoveKnot => {
            let inner = curve.and_then(|c| {
                let breaks = c.knots().breaks();
                (breaks.len() > 2).then(|| breaks[breaks.len() / 2])
            });
            vec![inner.map_or(String::new(), text), String::new()]
        }
        A::InsertKnotU => vec![text(centre.x)],
        A::InsertKnotV => vec![text(centre.y)],
        A::MoveBy | A::MoveSurfacePoints => vec!["0".into(); action.fields().len()],
        A::Rename => vec![record.name.clone().unwrap_or_default()],
        A::Layer => vec![record.layer.map_or(String::new(), |l| l.to_string())],
        _ => vec![String::new(); action.fields().len()],
    }
}
