//! Questions above everything: unsaved work, a file changed by somebody else, copies to recover. Enter gives the
//! first answer, Esc leaves things as they are.

use std::time::SystemTime;

use bevy::window::RequestRedraw;
use bevy_egui::egui::{self, Color32, Id, Modal, RichText, Ui};

use super::{Reads, Writes};
use crate::editor::document::{Answer, Discarding, Question, Questions};
use crate::editor::theme::size;
use crate::scene::file::recovery::Recoverable;

/// Shows the open question.
pub(super) fn show(ctx: &egui::Context, reads: &Reads, questions: &Questions, writes: &mut Writes) {
    let Some(question) = questions.open() else { return };
    let p = &reads.palette;
    let backdrop = Color32::from_black_alpha(if p.light { 60 } else { 120 });
    let modal = Modal::new(Id::new("question")).backdrop_color(backdrop).frame(super::sheet_frame(p));
    let enter = ctx.input_mut(|i| i.consume_key(egui::Modifiers::NONE, egui::Key::Enter));
    let mut answer = None;
    let response = modal.show(ctx, |ui| {
        ui.set_width(440.0);
        let (title, text) = words(question, &reads.document_name());
        ui.label(RichText::new(title).size(size::TITLE).color(p.strong));
        ui.add_space(6.0);
        ui.label(RichText::new(text).color(p.text));
        ui.add_space(12.0);
        if let Question::Recover(copies) = question {
            for copy in copies {
                answer = answer.take().or(copy_row(ui, copy, reads));
            }
            ui.add_space(6.0);
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let choices: &[(&str, Answer)] = match question {
                Question::Unsaved(_) => {
                    &[("Save", Answer::Save), ("Discard", Answer::Discard), ("Cancel", Answer::Cancel)]
                }
                Question::Changed { .. } => &[
                    ("Save as…", Answer::SaveAs),
                    ("Overwrite", Answer::Overwrite),
                    ("Cancel", Answer::Cancel),
                ],
                Question::Recover(_) => &[("Later", Answer::Cancel)],
            };
            for (index, (label, choice)) in choices.iter().enumerate() {
                let strong = index == 0 && choices.len() > 1;
                let text =
                    RichText::new(format!("  {label}  ")).color(if strong { p.accent } else { p.text });
                if ui.button(text).clicked() {
                    answer = Some(choice.clone());
                }
            }
        });
    });
    if enter && answer.is_none() {
        // What is offered first.
        answer = match question {
            Question::Unsaved(_) => Some(Answer::Save),
            Question::Changed { .. } => Some(Answer::SaveAs),
            Question::Recover(copies) => copies.first().map(|copy| Answer::Recover(copy.file.clone())),
        };
    }
    if response.should_close() && answer.is_none() {
        answer = Some(Answer::Cancel);
    }
    if let Some(answer) = answer {
        writes.answers.write(answer);
        writes.redraw.write(RequestRedraw);
    }
}

fn words(question: &Question, name: &str) -> (&'static str, String) {
    match question {
        Question::Unsaved(what) => {
            let before = match what {
                Discarding::Close => "closing it",
                Discarding::Open(_) => "opening another",
                Discarding::Quit => "quitting",
            };
            ("Unsaved changes", format!("Save the changes to {name} before {before}?"))
        }
        Question::Changed { path, .. } => {
            let text = format!(
                "{} was changed by another program or window since it was opened here. Overwriting it loses those changes.",
                path.display()
            );
            ("The file has changed", text)
        }
        Question::Recover(_) => (
            "Recover unsaved work",
            "An earlier session ended without saving. These copies were kept:".into(),
        ),
    }
}

fn copy_row(ui: &mut Ui, copy: &Recoverable, reads: &Reads) -> Option<Answer> {
    let p = &reads.palette;
    let mut answer = None;
    ui.horizontal(|ui| {
        let name = ui.label(RichText::new(&copy.note.name).color(p.strong));
        if let Some(path) = &copy.note.path {
            name.on_hover_text(path.display().to_string());
        }
        ui.label(RichText::new(age(copy.modified)).color(p.weak));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            if ui.button(RichText::new("Recover").color(p.accent)).clicked() {
                answer = Some(Answer::Recover(copy.file.clone()));
            }
            if ui.button("Remove").clicked() {
                answer = Some(Answer::Remove(copy.file.clone()));
            }
        });
    });
    answer
}

fn age(modified: Option<SystemTime>) -> String {
    let Some(age) = modified.and_then(|t| t.elapsed().ok()) else { return String::new() };
    let minutes = age.as_secs() / 60;
    match minutes {
        0 => "moments ago".into(),
        1..60 => format!("{minutes} min ago"),
        60..2880 => format!("{} h ago", minutes / 60),
        _ => format!("{} days ago", minutes / 1440),
    }
}
