//! Where pictures go.

use std::path::PathBuf;

/// Where pictures go: to one stem, with an ending for each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputPaths {
    /// The PNG.
    pub png: PathBuf,
}

/// Where the pictures of one light go.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PicturePaths {
    /// The PNG.
    pub png: PathBuf,
    /// The EXR of luminances.
    pub untonemapped_exr: PathBuf,
    /// The EXR of the developed picture.
    pub tonemapped_exr: PathBuf,
}

impl OutputPaths {
    /// From the path of the PNG; its siblings share its stem.
    pub fn new(png: impl Into<PathBuf>) -> Self {
        Self { png: png.into() }
    }

    /// Those of the light as it was rendered.
    pub fn pictures(&self) -> PicturePaths {
        PicturePaths {
            png: self.png.clone(),
            untonemapped_exr: self.sibling("_untonemapped.exr"),
            tonemapped_exr: self.sibling("_tonemapped.exr"),
        }
    }

    /// Those of the light denoised.
    pub fn denoised(&self) -> PicturePaths {
        PicturePaths {
            png: self.sibling("_denoised.png"),
            untonemapped_exr: self.sibling("_denoised_untonemapped.exr"),
            tonemapped_exr: self.sibling("_denoised_tonemapped.exr"),
        }
    }

    /// The EXR with layers.
    pub fn layers_exr(&self) -> PathBuf {
        self.sibling("_layers.exr")
    }

    /// The film.
    pub fn igi(&self) -> PathBuf {
        self.sibling(".igi")
    }

    /// All that may ever be written, but the PNG.
    pub fn siblings(&self) -> [PathBuf; 7] {
        let (pictures, denoised) = (self.pictures(), self.denoised());
        [
            self.igi(),
            self.layers_exr(),
            pictures.untonemapped_exr,
            pictures.tonemapped_exr,
            denoised.png,
            denoised.untonemapped_exr,
            denoised.tonemapped_exr,
        ]
    }

    fn sibling(&self, ending: &str) -> PathBuf {
        let stem = self.png.file_stem().unwrap_or_default().to_string_lossy();
        self.png.with_file_name(format!("{stem}{ending}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn siblings_share_the_stem() {
        let endings = [
            ".igi",
            "_layers.exr",
            "_untonemapped.exr",
            "_tonemapped.exr",
            "_denoised.png",
            "_denoised_untonemapped.exr",
            "_denoised_tonemapped.exr",
        ];
        let paths = OutputPaths::new("out/x.y.png");
        assert_eq!(paths.siblings(), endings.map(|ending| Path::new("out").join(format!("x.y{ending}"))));
        assert_eq!(paths.pictures().png, paths.png);
    }
}
