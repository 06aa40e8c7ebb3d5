//! Just enough of Embree 4's C interface, loaded at run time.
#![allow(unsafe_code)]

use indigo_geom::{Ray, TriangleMesh};
use libloading::Library;
use std::ffi::{CStr, c_char, c_void};
use std::mem::ManuallyDrop;
use std::path::{Path, PathBuf};
use std::ptr::null_mut;
use std::time::{Duration, Instant};

type Handle = *mut c_void;
type Set = unsafe extern "C" fn(Handle, i32);
type Act = unsafe extern "C" fn(Handle);
type Buffer = unsafe extern "C" fn(Handle, i32, u32, i32, usize, usize) -> Handle;

/// `RTCRay`.
#[repr(C, align(16))]
struct RtcRay {
    org: [f32; 3],
    tnear: f32,
    dir: [f32; 3],
    time: f32,
    tfar: f32,
    mask: u32,
    id: u32,
    flags: u32,
}

/// `RTCRayHit`; the instance fields have room for any build's stack depth.
#[repr(C, align(16))]
struct RtcRayHit {
    ray: RtcRay,
    normal: [f32; 3],
    u: f32,
    v: f32,
    primitive: u32,
    geometry: u32,
    instances: [u32; 9],
}

const INVALID: u32 = u32::MAX;

/// How a scene is built and traced.
#[derive(Clone, Copy)]
pub enum Mode {
    /// Default build.
    Medium,
    /// Spatial splits.
    High,
    /// Default build, robust traversal.
    MediumRobust,
}

/// The library; never unloaded, since its threads may outlive the last device.
pub struct Embree {
    library: ManuallyDrop<Library>,
}

/// A device with its number of threads.
pub struct Device<'a> {
    embree: &'a Embree,
    handle: Handle,
}

/// A built scene.
pub struct Scene<'a> {
    device: &'a Device<'a>,
    handle: Handle,
    intersect: unsafe extern "C" fn(Handle, *mut RtcRayHit, Handle),
    occluded: unsafe extern "C" fn(Handle, *mut RtcRay, Handle),
    /// Time of the commit alone.
    pub build: Duration,
}

fn library_like(folder: &Path, name: &str) -> Option<PathBuf> {
    let mut entries = std::fs::read_dir(folder).ok()?.filter_map(Result::ok).map(|e| e.path());
    entries.find(|p| p.file_name().is_some_and(|n| n.to_string_lossy().contains(name)))
}

impl Embree {
    /// Loads the library from a folder.
    pub fn load(folder: &Path) -> Result<Self, String> {
        // SAFETY: loading runs the libraries' initialisers, which are those of TBB and Embree.
        unsafe {
            let tasks = library_like(folder, "tbb").map(|p| Library::new(p)).transpose();
            // Embree needs its own copy of TBB in the process before it is loaded itself.
            std::mem::forget(tasks.map_err(|e| e.to_string())?);
            let path =
                library_like(folder, "embree4").ok_or(format!("no embree4 in {}", folder.display()))?;
            let library = Library::new(path).map_err(|e| e.to_string())?;
            Ok(Self { library: ManuallyDrop::new(library) })
        }
    }

    /// A function by name.
    ///
    /// # Safety
    /// `F` must be the function's type in Embree's headers.
    unsafe fn function<F: Copy>(&self, name: &str) -> F {
        // SAFETY: the caller vouches for the type.
        unsafe { *self.library.get::<F>(name.as_bytes()).expect("Embree 4 exports this") }
    }

    /// A device that builds with so many threads.
    pub fn device(&self, threads: usize) -> Device<'_> {
        let config = format!("threads={threads}\0");
        let config = CStr::from_bytes_with_nul(config.as_bytes()).expect("one nul at the end");
        // SAFETY: the signature of rtcNewDevice; the string outlives the call.
        let handle = unsafe {
            let new: unsafe extern "C" fn(*const c_char) -> Handle = self.function("rtcNewDevice");
            new(config.as_ptr())
        };
        assert!(!handle.is_null(), "Embree made no device");
        Device { embree: self, handle }
    }
}

impl Drop for Device<'_> {
    fn drop(&mut self) {
        // SAFETY: the handle is owned and released once.
        unsafe { self.embree.function::<unsafe extern "C" fn(Handle)>("rtcReleaseDevice")(self.handle) }
    }
}

impl Device<'_> {
    /// Builds a mesh.
    pub fn scene(&self, mesh: &TriangleMesh, mode: Mode) -> Scene<'_> {
        let e = self.embree;
        let (positions, triangles) = (mesh.positions(), mesh.triangles());
        // SAFETY: the signatures and constants of Embree 4's rtcore_scene.h and rtcore_geometry.h;
        // each buffer has room for what is copied into it.
        unsafe {
            let scene = e.function::<unsafe extern "C" fn(Handle) -> Handle>("rtcNewScene")(self.handle);
            e.function::<Set>("rtcSetSceneBuildQuality")(
                scene,
                if matches!(mode, Mode::High) { 2 } else { 1 },
            );
            e.function::<Set>("rtcSetSceneFlags")(
                scene,
                if matches!(mode, Mode::MediumRobust) { 4 } else { 0 },
            );
            let new = e.function::<unsafe extern "C" fn(Handle, i32) -> Handle>("rtcNewGeometry");
            let geometry = new(self.handle, 0);
            let buffer = e.function::<Buffer>("rtcSetNewGeometryBuffer");
            let to = buffer(geometry, 1, 0, 0x9003, 12, positions.len());
            to.cast::<[f32; 3]>().copy_from_nonoverlapping(positions.as_ptr(), positions.len());
            let to = buffer(geometry, 0, 0, 0x5003, 12, triangles.len());
            to.cast::<[u32; 3]>().copy_from_nonoverlapping(triangles.as_ptr(), triangles.len());
            e.function::<Act>("rtcCommitGeometry")(geometry);
            e.function::<unsafe extern "C" fn(Handle, Handle) -> u32>("rtcAttachGeometry")(scene, geometry);
            e.function::<Act>("rtcReleaseGeometry")(geometry);
            let start = Instant::now();
            e.function::<Act>("rtcCommitScene")(scene);
            let build = start.elapsed();
            let (intersect, occluded) = (e.function("rtcIntersect1"), e.function("rtcOccluded1"));
            Scene { device: self, handle: scene, intersect, occluded, build }
        }
    }
}

impl Drop for Scene<'_> {
    fn drop(&mut self) {
        // SAFETY: the handle is owned and released once.
        unsafe { self.device.embree.function::<unsafe extern "C" fn(Handle)>("rtcReleaseScene")(self.handle) }
    }
}

impl Scene<'_> {
    /// The distance of the closest hit, or infinity.
    #[inline]
    pub fn closest(&self, ray: &Ray) -> f32 {
        let mut query = RtcRayHit {
            ray: to_embree(ray),
            normal: [0.0; 3],
            u: 0.0,
            v: 0.0,
            primitive: 0,
            geometry: INVALID,
            instances: [INVALID; 9],
        };
        // SAFETY: rtcIntersect1 with a committed scene, an aligned ray and no arguments.
        unsafe { (self.intersect)(self.handle, &raw mut query, null_mut()) };
        if query.geometry == INVALID { f32::INFINITY } else { query.ray.tfar }
    }

    /// Whether anything is hit.
    #[inline]
    pub fn any(&self, ray: &Ray) -> bool {
        let mut query = to_embree(ray);
        // SAFETY: rtcOccluded1 with a committed scene, an aligned ray and no arguments.
        unsafe { (self.occluded)(self.handle, &raw mut query, null_mut()) };
        query.tfar < 0.0
    }
}

#[inline]
fn to_embree(ray: &Ray) -> RtcRay {
    RtcRay {
        org: ray.o.to_array(),
        tnear: ray.t_min,
        dir: ray.d.to_array(),
        time: 0.0,
        tfar: ray.t_max,
        mask: u32::MAX,
        id: 0,
        flags: 0,
    }
}
