//! Groups of lights, each of which has layers of its own in a film, and how bright each is in the picture.

/// The most groups that a film keeps apart.
pub const MOST_GROUPS: usize = 16;

/// A group of lights.
#[derive(Clone, Debug, PartialEq)]
pub struct LightGroup {
    /// Its name, which no other group of the film has.
    pub name: String,
    /// What its light is multiplied by in the picture, if it is on.
    pub gain: f64,
    /// Whether its light is in the picture.
    pub is_on: bool,
    /// The number of the scene's `layer_setting` that tells this; none of lights that are of no layer.
    pub layer: Option<u16>,
}

impl LightGroup {
    /// What its light is multiplied by in the picture.
    pub fn shown(&self) -> f64 {
        if self.is_on { self.gain } else { 0.0 }
    }
}

/// How bright the groups of lights are in the picture, in the order of their numbers; none where a film holds all light
/// together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LightMix(pub Vec<LightGroup>);

impl LightMix {
    /// What the light of a film's layer is multiplied by. Layers of no group, or of one that is not known here, are as they
    /// are.
    pub fn gain(&self, layer: &str) -> f64 {
        let group = split(layer).1.and_then(|name| self.0.iter().find(|group| group.name == name));
        group.map_or(1.0, LightGroup::shown)
    }

    /// Whether the light of any group is in the picture.
    pub fn shows_any(&self) -> bool {
        self.0.is_empty() || self.0.iter().any(|group| group.shown() > 0.0)
    }
}

/// The name of a layer that holds a part of one group's light.
pub fn layer_of_group(part: &str, group: &str) -> String {
    format!("{part} [{group}]")
}

/// The part of the light that a layer of a name holds, and the group whose it is.
pub fn split(layer: &str) -> (&str, Option<&str>) {
    let group = layer.split_once(" [").and_then(|(part, rest)| Some((part, rest.strip_suffix(']')?)));
    group.map_or((layer, None), |(part, group)| (part, Some(group)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_tell_their_groups() {
        for group in ["lamps", "", "the [left] one", "a ] b"] {
            let layer = layer_of_group("camera indirect", group);
            assert_eq!(split(&layer), ("camera indirect", Some(group)));
        }
        assert_eq!(split("metropolis"), ("metropolis", None));
        let mut mix =
            LightMix(vec![LightGroup { name: "lamps".to_owned(), gain: 0.25, is_on: true, layer: Some(0) }]);
        let gains =
            |mix: &LightMix| ["camera [lamps]", "camera [sky]", "camera"].map(|layer| mix.gain(layer));
        assert_eq!(gains(&mix), [0.25, 1.0, 1.0]);
        assert!(mix.shows_any() && LightMix::default().shows_any());
        mix.0[0].is_on = false;
        assert_eq!(gains(&mix), [0.0, 1.0, 1.0]);
        assert!(!mix.shows_any());
    }
}
