//! The status page: for people, for scripts (`/status.json`) and for Prometheus (`/metrics`).
//!
//! It only shows, and changes nothing. By itself it listens to this machine alone, and then answers only whoever calls it by
//! a name of this machine: no page of the web can read it by giving its own name this machine's address.

mod text;
mod visitors;

use crate::master::Status;
use axum::Router;
use axum::body::Body;
use axum::extract::{Request, State};
use axum::http::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, CONTENT_TYPE, HOST, X_CONTENT_TYPE_OPTIONS,
};
use axum::http::{HeaderValue, StatusCode};
use axum::middleware::{Next, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use bytes::Bytes;
use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::UNIX_EPOCH;
use tokio::net::TcpListener;
use visitors::Door;
pub use visitors::Refuse;

/// The largest picture that is shown, in bytes.
const LARGEST_PICTURE: u64 = 256 << 20;

/// What the page shows.
#[derive(Clone)]
pub struct View {
    /// How things stand.
    pub status: Arc<dyn Fn() -> Status + Send + Sync>,
    /// Where the picture is saved.
    pub picture: PathBuf,
    /// The picture as it was read last, with its version: all who look share it.
    pub read: Arc<Mutex<(u128, Bytes)>>,
    /// Is told of visitors who had to make room for others.
    pub refuse: Refuse,
}

impl View {
    /// The picture as it was saved last, if there is one of a size that is shown.
    fn picture(&self) -> Option<Bytes> {
        let saved = std::fs::metadata(&self.picture).ok()?;
        let version = saved.modified().ok()?.duration_since(UNIX_EPOCH).ok()?.as_nanos();
        let mut read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        if read.0 != version || read.1.is_empty() {
            *read = (0, Bytes::new());
            if !(1..=LARGEST_PICTURE).contains(&saved.len()) {
                return None;
            }
            *read = (version, std::fs::read(&self.picture).ok()?.into());
        }
        Some(read.1.clone())
    }

    /// Tells one picture from another: when it was saved, in milliseconds; 0 if there is none.
    fn picture_version(&self) -> u64 {
        let saved = std::fs::metadata(&self.picture).ok().filter(|meta| meta.len() > 0);
        let saved = saved.and_then(|meta| meta.modified().ok()?.duration_since(UNIX_EPOCH).ok());
        saved.map_or(0, |since| since.as_millis() as u64)
    }
}

/// Answers until the runtime ends.
pub async fn serve(listener: TcpListener, view: View) -> std::io::Result<()> {
    let is_local = listener.local_addr()?.ip().is_loopback();
    let files = [
        ("/", "text/html; charset=utf-8", include_str!("page.html")),
        ("/page.css", "text/css; charset=utf-8", include_str!("page.css")),
        ("/icon.svg", "image/svg+xml", include_str!("icon.svg")),
        ("/page.js", "text/javascript; charset=utf-8", include_str!("page.js")),
    ];
    let mut router = Router::new()
        .route("/status.json", get(status_json))
        .route("/metrics", get(metrics))
        .route("/picture.png", get(picture));
    for (path, kind, content) in files {
        router = router.route(path, get(move || async move { ([(CONTENT_TYPE, kind)], content) }));
    }
    let door = Door::new(listener, Arc::clone(&view.refuse));
    let router = router.layer(from_fn_with_state(is_local, guard)).with_state(view);
    axum::serve(door, router).await
}

/// Sees to it that nobody else's page gets what this one shows.
async fn guard(State(is_local): State<bool>, request: Request, next: Next) -> Response {
    let host = request.headers().get(HOST).and_then(|host| host.to_str().ok()).unwrap_or_default();
    if is_local && !is_this_machine(host) {
        return (StatusCode::FORBIDDEN, "this page is for this machine").into_response();
    }
    let mut response = next.run(request).await;
    let headers = response.headers_mut();
    let policy = "default-src 'none'; img-src 'self'; style-src 'self'; script-src 'self'; connect-src 'self'; \
                  frame-ancestors 'none'; base-uri 'none'";
    headers.insert(CONTENT_SECURITY_POLICY, HeaderValue::from_static(policy));
    headers.insert(X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    headers.insert(CACHE_CONTROL, HeaderValue::from_static("no-store"));
    response
}

/// Whether a name with or without a port is this machine's own.
fn is_this_machine(host: &str) -> bool {
    let name = match host.strip_prefix('[') {
        Some(rest) => rest.split(']').next().unwrap_or_default(),
        None => host.rsplit_once(':').map_or(host, |(name, _)| name),
    };
    name.eq_ignore_ascii_case("localhost")
        || name.parse::<IpAddr>().is_ok_and(|address| address.is_loopback())
}

async fn status_json(State(view): State<View>) -> Response {
    told("application/json", move || text::json(&(view.status)(), view.picture_version())).await
}

async fn metrics(State(view): State<View>) -> Response {
    told("text/plain; version=0.0.4", move || text::metrics(&(view.status)())).await
}

/// A text that takes the film's lock, which whoever copies the film holds for long: the threads that talk to slaves do not
/// wait for that.
async fn told(kind: &'static str, text: impl FnOnce() -> String + Send + 'static) -> Response {
    match tokio::task::spawn_blocking(text).await {
        Ok(text) => ([(CONTENT_TYPE, kind)], text).into_response(),
        Err(_) => StatusCode::INTERNAL_SERVER_ERROR.into_response(),
    }
}

/// The picture as it was saved last.
async fn picture(State(view): State<View>) -> Response {
    match tokio::task::spawn_blocking(move || view.picture()).await {
        Ok(Some(bytes)) => ([(CONTENT_TYPE, "image/png")], Body::from(bytes)).into_response(),
        _ => (StatusCode::NOT_FOUND, "no picture has been saved yet").into_response(),
    }
}

/// Listens for those who want to see.
///
/// # Errors
/// What the system says.
pub async fn listen(address: SocketAddr) -> std::io::Result<TcpListener> {
    TcpListener::bind(address).await
}

#[cfg(test)]
mod tests {
    use super::is_this_machine;

    #[test]
    fn other_names_of_this_machine_are_strangers() {
        for host in ["localhost", "LOCALHOST:8080", "127.0.0.1", "127.0.0.1:8080", "[::1]:8080", "[::1]"] {
            assert!(is_this_machine(host), "{host}");
        }
        for host in
            ["", "evil.example", "evil.example:8080", "localhost.evil.example", "10.0.0.1:8080", "[fe80::1]"]
        {
            assert!(!is_this_machine(host), "{host}");
        }
    }
}
