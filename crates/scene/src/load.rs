//! Loading: read, bind, lower, and gather everything that is wrong.

use crate::identity::{Outline, Witness};
use crate::lower;
use crate::scene::{Development, Scene};
use crate::schema::SCENE;
use crate::schema::settings::RENDERER_SETTINGS;
use crate::settings::{Origin, Settings};
use indigo_decl::{Element, Node, Resolver, bind};
use indigo_diag::{Sink, SourceMap, Span, Spanned};
use indigo_geom::{NoStore, Stop, TreeStore};
use indigo_igs::{Limits, read_document, read_scene_until};
use std::collections::HashSet;

/// A setting given on the command line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Override<'a> {
    /// The option as the user writes it, such as `-halt`, for messages. Empty for a setting that the option before
    /// it sets besides.
    pub option: &'a str,
    /// Name of the setting.
    pub setting: &'a str,
    /// Its value as text.
    pub value: String,
}

/// What a front end adds to a scene.
pub struct LoadOptions<'a> {
    /// Where bytes come from.
    pub resolver: &'a dyn Resolver,
    /// Where built trees are kept.
    pub trees: &'a dyn TreeStore,
    /// Path of the settings file, if there is one.
    pub inifile: Option<&'a str>,
    /// Settings given on the command line.
    pub overrides: &'a [Override<'a>],
    /// Limits on files.
    pub limits: Limits,
    /// Whether to check only: no trees are built and no scene comes out.
    pub check_only: bool,
    /// Ends loading early: no scene comes out then, and what was found tells less than all.
    pub stop: Option<&'a Stop>,
}

impl<'a> LoadOptions<'a> {
    /// To load a scene whose bytes come from a resolver: no trees are kept, nothing is added, and limits are the usual.
    pub fn new(resolver: &'a dyn Resolver) -> Self {
        Self {
            resolver,
            trees: &NoStore,
            inifile: None,
            overrides: &[],
            limits: Limits::default(),
            check_only: false,
            stop: None,
        }
    }

    pub(crate) fn is_stopped(&self) -> bool {
        self.stop.is_some_and(Stop::is_set)
    }
}

/// A scene as far as it could be loaded.
pub struct Loaded {
    /// The scene, if nothing was wrong with it and more than checking was asked for.
    pub scene: Option<Scene>,
    /// All settings with their origins.
    pub settings: Option<Settings>,
    /// All files that were read.
    pub sources: SourceMap,
    /// Everything that was found.
    pub sink: Sink,
}

/// What developing a film takes, as far as it could be loaded.
pub struct LoadedDevelopment {
    /// The part of the scene, if nothing was wrong with it.
    pub development: Option<Development>,
    /// All files that were read.
    pub sources: SourceMap,
    /// Everything that was found.
    pub sink: Sink,
}

/// The elements of a scene and its settings, bound.
pub(crate) struct Bound {
    /// What the elements say.
    outline: Outline,
    pub root: Node,
    settings: Settings,
}

/// Loads a scene. Everything that is wrong is in the result's sink; a scene comes with no errors only.
pub fn load(path: &str, options: &LoadOptions) -> Loaded {
    let mut sources = SourceMap::default();
    let mut sink = Sink::new();
    let Some(bound) = read_and_bind(path, options, &mut sources, &mut sink) else {
        return Loaded { scene: None, settings: None, sources, sink };
    };
    let witness = Witness::new(options.resolver);
    let witnessed = LoadOptions { resolver: &witness, ..*options };
    let context = lower::Context {
        options: &witnessed,
        placeholders: bound.settings.bool("placeholders"),
        development: options.resolver,
        sources: &mut sources,
        sink: &mut sink,
        asked: HashSet::new(),
        missing: HashSet::new(),
    };
    let mut scene = lower::lower(&bound.root, &bound.settings, path, context)
        .filter(|_| !sink.has_errors() && !options.is_stopped());
    if let Some(scene) = &mut scene {
        let mut paths = HashSet::new();
        bound.root.visit_paths(&mut |_, span| _ = paths.insert(span));
        scene.identity.hash = witness.identity(&bound.outline, &paths, &sources);
    }
    Loaded { scene, settings: Some(bound.settings), sources, sink }
}

/// Loads only what developing a film takes: no mesh file is read and no tree built. Faults elsewhere in the
/// scene are not looked for.
pub fn load_development(path: &str, options: &LoadOptions) -> LoadedDevelopment {
    let mut sources = SourceMap::default();
    let mut sink = Sink::new();
    let development = read_and_bind(path, options, &mut sources, &mut sink).and_then(|bound| {
        let context = lower::Context {
            options,
            placeholders: bound.settings.bool("placeholders"),
            development: options.resolver,
            sources: &mut sources,
            sink: &mut sink,
            asked: HashSet::new(),
            missing: HashSet::new(),
        };
        lower::development(&bound.root, &bound.settings, path, context)
    });
    LoadedDevelopment { development: development.filter(|_| !sink.has_errors()), sources, sink }
}

pub(crate) fn read_and_bind(
    path: &str,
    options: &LoadOptions,
    sources: &mut SourceMap,
    sink: &mut Sink,
) -> Option<Bound> {
    let is_stopped = || options.is_stopped();
    let root = read_scene_until(path, options.resolver, sources, sink, &options.limits, &is_stopped)?;
    let outline = Outline::new(&root);
    let nowhere = root.span;
    let root = bind(root, &SCENE, sink);
    let mut layers = vec![];
    if let Some(node) = command_line(options.overrides, sources, sink) {
        layers.push((Origin::CommandLine, node));
    }
    let (scene_settings, root) = take_settings(root);
    layers.extend(scene_settings.map(|node| (Origin::Scene, node)));
    if let Some(node) = options.inifile.and_then(|ini| read_inifile(ini, options, sources, sink)) {
        layers.push((Origin::IniFile, node));
    }
    Some(Bound { outline, root, settings: Settings::new(layers, nowhere) })
}

/// The settings become a layer of their own, apart from the rest of the scene.
fn take_settings(mut root: Node) -> (Option<Node>, Node) {
    (root.take_node(RENDERER_SETTINGS.name), root)
}

/// The settings of the command line as an element whose places lie in a file that holds the options as they were
/// given.
fn command_line(overrides: &[Override], sources: &mut SourceMap, sink: &mut Sink) -> Option<Node> {
    if overrides.is_empty() {
        return None;
    }
    let mut text = String::new();
    let mut ranges = vec![];
    for Override { option, value, .. } in overrides {
        if option.is_empty() {
            ranges.push(ranges.last().copied().unwrap_or_default());
            continue;
        }
        text.push_str(option);
        text.push(' ');
        ranges.push((text.len(), text.len() + value.len()));
        text.push_str(value);
        text.push(' ');
    }
    let source = sources.add("command line", text.into_bytes().into(), None)?;
    let mut element = Element::new(RENDERER_SETTINGS.name, Span::new(source, 0, 0));
    for (Override { setting, value, .. }, (start, end)) in overrides.iter().zip(ranges) {
        let span = Span::new(source, start, end);
        let mut child = Element::new(setting, span);
        child.text = Spanned::new(value.as_str().into(), span);
        element.children.push(child);
    }
    Some(bind(element, &RENDERER_SETTINGS, sink))
}

fn read_inifile(path: &str, options: &LoadOptions, sources: &mut SourceMap, sink: &mut Sink) -> Option<Node> {
    let root = read_document(path, options.resolver, sources, sink, &options.limits)?;
    Some(bind(root, &RENDERER_SETTINGS, sink))
}
