//! What the files of a picture say of it.

use super::SaveJob;
use crate::calendar::Moment;
use indigo_film::{FilmRecord, FilmSize};
use indigo_imaging::{Metadata, PictureSettings, RenderFacts};
use indigo_scene::{DIFFRACTION_OF_RAYS, Development};
use std::time::SystemTime;

/// How a film was rendered and is developed, and by what camera.
pub(super) fn of(job: &SaveJob, size: FilmSize, record: Option<&FilmRecord>) -> Metadata {
    let nothing = FilmRecord::default();
    let record = record.unwrap_or(&nothing);
    let mut metadata = render_facts(job, size, record).metadata();
    let Development { picture, camera, .. } = &job.development;
    describe(picture, record, &mut metadata);
    metadata.set("aperture_area", picture.exposure.aperture_area);
    camera.describe(&mut metadata);
    metadata.camera = Some(*camera);
    let Moment { date: [year, month, day], time: [hour, minute, second] } = Moment::of(SystemTime::now());
    metadata.captured = Some(format!("{year:04}:{month:02}:{day:02} {hour:02}:{minute:02}:{second:02}"));
    metadata
}

/// What a film knows of itself, and how it is developed.
pub(super) fn of_film(
    size: FilmSize,
    record: Option<&FilmRecord>,
    picture: &PictureSettings,
    program: &str,
) -> Metadata {
    let mut metadata = Metadata::default();
    metadata.set("Indigo version used", program);
    metadata.set("width", size.width());
    metadata.set("height", size.height());
    metadata.set("super_sample_factor", size.super_sample());
    match record {
        Some(record) => {
            metadata.set("scene_file_path", &record.scene_path);
            metadata.set("num_samples", record.samples);
            metadata.set("render time elapsed", format!("{:.5}", record.elapsed_s));
            describe(picture, record, &mut metadata);
        }
        None => picture.describe(&mut metadata),
    }
    metadata
}

/// How a film was sampled and is developed.
fn describe(picture: &PictureSettings, record: &FilmRecord, metadata: &mut Metadata) {
    picture.describe(metadata);
    if let Some(filter) = record.setting("splat_filter") {
        metadata.set("splat_filter", filter);
    }
    if record.setting(DIFFRACTION_OF_RAYS) == Some("true") {
        metadata.set("aperture_diffraction", "of rays");
    }
    let seeds: Vec<String> = record.runs.iter().map(|run| run.seed.to_string()).collect();
    metadata.set("seed", seeds.join(" "));
}

fn render_facts(job: &SaveJob, size: FilmSize, record: &FilmRecord) -> RenderFacts {
    let Development { transport, output, .. } = &job.development;
    let metropolis = transport.metropolis;
    RenderFacts {
        version: job.version.clone(),
        scene_path: output.scene_path.clone(),
        width: size.width(),
        height: size.height(),
        super_sample_factor: size.super_sample(),
        bidirectional: transport.bidirectional,
        // Without Metropolis sampling nothing is mutated: 0.
        metropolis: metropolis.is_some(),
        hybrid: transport.hybrid,
        large_mutation_prob: metropolis.map_or(0.0, |m| m.large_mutation_prob),
        max_change: metropolis.map_or(0.0, |m| f64::from(m.max_change)),
        max_num_consec_rejections: metropolis
            .map_or(0, |m| u32::try_from(m.max_consecutive_rejections).unwrap_or(u32::MAX)),
        max_depth: transport.max_depth,
        num_threads: job.threads as u32,
        num_samples: record.samples as f64,
        elapsed_s: record.elapsed_s,
    }
}
