//! The table of slaves.

use super::foot::readable;
use crate::log::Weight;
use crate::{theme, words};
use eframe::egui::{Align, Grid, Label, Layout, RichText, ScrollArea, Ui, vec2};
use indigo_front::messages::{clock, scaled};
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

/// The table, which is of a render that goes on or has ended; the error that is to be read as a whole.
pub fn slaves(ui: &mut Ui, status: Option<&Status>, goes_on: bool) -> Option<String> {
    let status = status?;
    if status.slaves.is_empty() && status.own.is_none() {
        ui.weak(words::NO_SLAVES);
        return None;
    }
    let mut read = None;
    ScrollArea::both().id_salt("slaves").auto_shrink(false).show(ui, |ui| {
        Grid::new("slaves").striped(true).num_columns(COLUMNS.len()).spacing([12.0, 4.0]).show(ui, |ui| {
            for (head, width, is_number) in COLUMNS {
                cell(ui, RichText::new(head).weak(), width, is_number);
            }
            ui.end_row();
            if let Some(own) = status.own {
                let threads = own.threads.to_string();
                let rate = if goes_on { scaled(own.samples_per_second) } else { String::new() };
                let state = if goes_on { words::RENDERS } else { words::HAS_ENDED };
                let texts = [words::THIS_MACHINE, "", state, &threads, &rate, "", "", "", ""];
                line(ui, &texts, None);
            }
            for slave in &status.slaves {
                if of_slave(ui, slave, goes_on) {
                    read.clone_from(&slave.last_error);
                }
            }
        });
    });
    if status.refused > 0 {
        ui.weak(words::refused(status.refused));
    }
    read
}

/// Whether its error is to be read.
fn of_slave(ui: &mut Ui, slave: &SlaveStatus, goes_on: bool) -> bool {
    let rate =
        if goes_on && slave.presence.is_there() { scaled(slave.samples_per_second) } else { String::new() };
    let texts = [
        &*slave.name,
        &slave.peer.to_string(),
        if !goes_on && slave.presence.is_there() { words::HAS_ENDED } else { slave.presence.word() },
        &slave.threads.to_string(),
        &rate,
        &scaled(slave.samples as f64),
        &slave.uploads.to_string(),
        &slave.last_upload.map(|since| words::ago(&clock(since))).unwrap_or_default(),
        &slave.errors.to_string(),
    ];
    line(ui, &texts, slave.last_error.as_deref())
}

/// A line of the table; where there was an error it is told, and read as a whole when it is pressed.
fn line(ui: &mut Ui, texts: &[&str; COLUMNS.len()], error: Option<&str>) -> bool {
    let mut is_read = false;
    for (text, (head, width, is_number)) in texts.iter().zip(COLUMNS) {
        let text = RichText::new(*text);
        let text = match error {
            Some(_) => text.color(theme::of_weight(Weight::Warning, ui.visuals())),
            None => text,
        };
        match error {
            Some(error) if head == words::SLAVE_ERRORS => {
                is_read |= in_cell(ui, width, is_number, |ui| readable(ui, text, error));
            }
            _ => cell(ui, text, width, is_number),
        }
    }
    ui.end_row();
    is_read
}

fn cell(ui: &mut Ui, text: RichText, width: f32, is_number: bool) {
    in_cell(ui, width, is_number, |ui| ui.add(Label::new(text).truncate()));
}

fn in_cell<R>(ui: &mut Ui, width: f32, is_number: bool, add: impl FnOnce(&mut Ui) -> R) -> R {
    let layout =
        if is_number { Layout::right_to_left(Align::Center) } else { Layout::left_to_right(Align::Center) };
    let size = vec2(width, ui.spacing().interact_size.y);
    let cell = ui.allocate_ui_with_layout(size, layout, |ui| {
        ui.set_min_width(width);
        add(ui)
    });
    cell.inner
}
