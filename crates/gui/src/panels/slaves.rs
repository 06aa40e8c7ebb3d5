//! The table of slaves.

use crate::log::Weight;
use crate::{theme, words};
use eframe::egui::{Align, Grid, Layout, RichText, ScrollArea, Ui, vec2};
use indigo_front::messages::{clock, count, scaled};
use indigo_net::master::{SlaveStatus, Status};

/// A column: its head, its width in points, and whether its numbers stand at the right.
const COLUMNS: [(&str, f32, bool); 9] = [
    (words::SLAVE_MACHINE, 150.0, false),
    (words::SLAVE_ADDRESS, 150.0, false),
    (words::SLAVE_STATE, 70.0, false),
    (words::THREADS, 56.0, true),
    (words::SLAVE_RATE, 80.0, true),
    (words::SAMPLES, 72.0, true),
    (words::SLAVE_UPLOADS, 60.0, true),
    (words::SLAVE_LAST, 90.0, true),
    (words::SLAVE_ERRORS, 50.0, true),
];

/// See the module.
pub fn slaves(ui: &mut Ui, status: Option<&Status>) {
    let Some(status) = status else { return };
    if status.slaves.is_empty() && status.own.is_none() {
        ui.weak(words::NO_SLAVES);
        return;
    }
    ScrollArea::both().id_salt("slaves").auto_shrink(false).show(ui, |ui| {
        Grid::new("slaves").striped(true).num_columns(COLUMNS.len()).spacing([12.0, 4.0]).show(ui, |ui| {
            for (head, width, is_number) in COLUMNS {
                cell(ui, RichText::new(head).weak(), width, is_number);
            }
            ui.end_row();
            if let Some(own) = status.own {
                let threads = own.threads.to_string();
                let rate = scaled(own.samples_per_second);
                let texts = [words::THIS_MACHINE, "", words::RENDERS, &threads, &rate, "", "", "", ""];
                line(ui, &texts, None);
            }
            for slave in &status.slaves {
                of_slave(ui, slave);
            }
        });
    });
    if status.refused > 0 {
        ui.weak(words::refused(&count(status.refused as usize, "connection")));
    }
}

fn of_slave(ui: &mut Ui, slave: &SlaveStatus) {
    let rate = if slave.presence.is_there() { scaled(slave.samples_per_second) } else { String::new() };
    let texts = [
        &*slave.name,
        &slave.peer.to_string(),
        slave.presence.word(),
        &slave.threads.to_string(),
        &rate,
        &scaled(slave.samples as f64),
        &slave.uploads.to_string(),
        &slave.last_upload.map(|since| words::ago(&clock(since))).unwrap_or_default(),
        &slave.errors.to_string(),
    ];
    line(ui, &texts, slave.last_error.as_deref());
}

/// A line of the table; an error is told where there was one.
fn line(ui: &mut Ui, texts: &[&str; COLUMNS.len()], error: Option<&str>) {
    for (text, (_, width, is_number)) in texts.iter().zip(COLUMNS) {
        let text = RichText::new(*text);
        let text = match error {
            Some(_) => text.color(theme::of_weight(Weight::Warning, ui.visuals())),
            None => text,
        };
        let response = cell(ui, text, width, is_number);
        if let Some(error) = error {
            response.on_hover_text(error);
        }
    }
    ui.end_row();
}

fn cell(ui: &mut Ui, text: RichText, width: f32, is_number: bool) -> eframe::egui::Response {
    let layout =
        if is_number { Layout::right_to_left(Align::Center) } else { Layout::left_to_right(Align::Center) };
    let size = vec2(width, ui.spacing().interact_size.y);
    ui.allocate_ui_with_layout(size, layout, |ui| {
        ui.set_min_width(width);
        ui.add(eframe::egui::Label::new(text).truncate())
    })
    .inner
}
