//! The HTTP side of a preview: requests in, pages, pictures and JSON out.
//!
//! Only this machine's browser is answered, and only our own page may ask: another site that a browser has open can send
//! requests to loopback addresses too. Host and Origin must be ours, `Sec-Fetch-Site` must not tell of another site, and
//! what draws or writes needs a token that only our page holds.

use std::convert::Infallible;
use std::sync::Arc;
use std::time::{Duration, Instant};

use axum::body::{Body, Bytes, to_bytes};
use axum::extract::{Path, Query, Request, State};
use axum::http::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, CONTENT_TYPE, HOST, HeaderName, HeaderValue, ORIGIN, REFERRER_POLICY,
    X_CONTENT_TYPE_OPTIONS,
};
use axum::http::{HeaderMap, Method, StatusCode};
use axum::middleware::{Next, from_fn_with_state};
use axum::response::sse::{Event, KeepAlive, Sse};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Json, Router};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use tokio_stream::StreamExt;
use tokio_stream::wrappers::UnboundedReceiverStream;

use super::assets::{ASSETS, INDEX};
use super::draw::{Progress, draw, written};
use super::measure::measure;
use super::pictures::Picture;
use super::save::save;
use super::session::{Session, Wanted};
use super::tiles;
use super::write_back::{Refused, Writing, write_back};
use crate::cli::build::Kind;

/// What the page may load: its own files, and pictures that it makes itself.
const POLICY: &str = "default-src 'self'; img-src 'self' blob: data:; style-src 'self' 'unsafe-inline'; \
                      base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// The header in which our page shows its token.
const TOKEN: &str = "x-kake-token";

const SITE: HeaderName = HeaderName::from_static("sec-fetch-site");
const MODE: HeaderName = HeaderName::from_static("sec-fetch-mode");
const DESTINATION: HeaderName = HeaderName::from_static("sec-fetch-dest");
const RESOURCE_POLICY: HeaderName = HeaderName::from_static("cross-origin-resource-policy");

/// How often an idle stream of events says that it is still there.
const SIGN: Duration = Duration::from_secs(15);

/// How often the page is told where a drawing is that takes long.
const TELL: Duration = Duration::from_millis(500);

/// A preview and the port it is served on.
#[derive(Clone)]
pub(super) struct Served {
    pub(super) session: Arc<Session>,
    pub(super) port: u16,
}

/// The most bytes of words about a request that was refused.
const LONGEST_REFUSAL: usize = 4096;

/// Every address of a preview.
pub(super) fn router(served: Served) -> Router {
    Router::new()
        .route("/", get(index))
        .route("/page/{file}", get(asset))
        .route("/api/draw", post(draw_scene))
        .route("/api/picture/{name}", get(picture))
        .route("/api/picture/{id}/tile/{z}/{x}/{y}", get(tile))
        .route("/api/picture/{id}/thumb.png", get(thumb))
        .route("/api/picture/{id}/metrics", get(metrics))
        .route("/api/save", post(save_picture))
        .route("/api/params", post(write_params))
        .route("/api/events", get(events))
        .fallback(async || Failed::new(StatusCode::NOT_FOUND, "there is nothing at this address"))
        .method_not_allowed_fallback(async || {
            Failed::new(StatusCode::METHOD_NOT_ALLOWED, "this address is not asked in this way")
        })
        .layer(from_fn_with_state(served.clone(), guard))
        .with_state(served)
}

/// What went wrong, in words.
#[derive(Debug)]
pub(super) struct Failed(StatusCode, String);

impl Failed {
    pub(super) fn new(status: StatusCode, words: impl Into<String>) -> Self {
        Self(status, words.into())
    }

    fn bad(words: impl Into<String>) -> Self {
        Self::new(StatusCode::BAD_REQUEST, words)
    }

    fn fault(words: impl Into<String>) -> Self {
        Self::new(StatusCode::INTERNAL_SERVER_ERROR, words)
    }

    fn unknown() -> Self {
        Self::new(StatusCode::NOT_FOUND, "this picture is not kept any more; draw it again")
    }
}

impl IntoResponse for Failed {
    fn into_response(self) -> Response {
        (self.0, Json(json!({ "error": self.1 }))).into_response()
    }
}

/// Lets our page through, and nobody else; says in every answer what a browser may do with it.
async fn guard(State(served): State<Served>, request: Request, next: Next) -> Response {
    let mut response = match may(&served, request.method(), request.uri().path(), request.headers()) {
        Ok(()) => in_our_words(next.run(request).await).await,
        Err(words) => Failed::new(StatusCode::FORBIDDEN, words).into_response(),
    };
    let headers = response.headers_mut();
    headers.insert(CONTENT_SECURITY_POLICY, HeaderValue::from_static(POLICY));
    headers.insert(X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    headers.insert(REFERRER_POLICY, HeaderValue::from_static("no-referrer"));
    headers.insert(RESOURCE_POLICY, HeaderValue::from_static("same-origin"));
    headers.entry(CACHE_CONTROL).or_insert(HeaderValue::from_static("no-store"));
    response
}

/// An answer as the page reads it: what was refused before it came to us is said in JSON too.
async fn in_our_words(response: Response) -> Response {
    let status = response.status();
    let is_json = response.headers().get(CONTENT_TYPE).is_some_and(|kind| kind.as_bytes() == b"application/json");
    if is_json || !(status.is_client_error() || status.is_server_error()) {
        return response;
    }
    let said = to_bytes(response.into_body(), LONGEST_REFUSAL).await.unwrap_or_default();
    Failed::new(status, String::from_utf8_lossy(&said)).into_response()
}

/// Whether a request is our page's.
fn may(served: &Served, method: &Method, path: &str, headers: &HeaderMap) -> Result<(), String> {
    let text = |name: &HeaderName| headers.get(name).map(|value| value.to_str().unwrap_or("?"));
    let is_ours = |host: &str| {
        let (name, port) = match host.rsplit_once(':') {
            Some((name, port)) if port.bytes().all(|digit| digit.is_ascii_digit()) => (name, port.parse().ok()),
            _ => (host, Some(80)),
        };
        (name == "127.0.0.1" || name.eq_ignore_ascii_case("localhost")) && port == Some(served.port)
    };
    if !text(&HOST).is_some_and(is_ours) {
        return Err(format!("this preview answers to 127.0.0.1:{} only", served.port));
    }
    if let Some(origin) = text(&ORIGIN)
        && !origin.strip_prefix("http://").is_some_and(is_ours)
    {
        return Err(format!("this preview answers its own page only, not {origin}"));
    }
    // The page itself may be opened from anywhere, by a link say, but not inside another page.
    let is_opened = method == Method::GET
        && path == "/"
        && text(&MODE) == Some("navigate")
        && text(&DESTINATION).is_none_or(|destination| destination == "document");
    if let Some(site) = text(&SITE)
        && !matches!(site, "same-origin" | "none")
        && !is_opened
    {
        return Err("this preview answers its own page only, not another site".to_owned());
    }
    if method == Method::POST && text(&HeaderName::from_static(TOKEN)) != Some(&served.session.token) {
        return Err("this needs the token of the preview's page; load the page again".to_owned());
    }
    Ok(())
}

/// The page, with its token.
async fn index(State(Served { session, .. }): State<Served>) -> Response {
    let scene = session.settings.given.to_string_lossy();
    let escaped = scene.replace('&', "&amp;").replace('"', "&quot;").replace('<', "&lt;");
    let text = INDEX
        .replace("content=\"TOKEN\"", &format!("content=\"{}\"", session.token))
        .replace("content=\"scene.kake\"", &format!("content=\"{escaped}\""));
    ([(CONTENT_TYPE, "text/html; charset=utf-8")], text).into_response()
}

async fn asset(Path(file): Path<String>) -> Result<Response, Failed> {
    let asset = ASSETS.iter().find(|asset| asset.name == file);
    let asset = asset.ok_or_else(|| Failed::new(StatusCode::NOT_FOUND, "the page has no such file"))?;
    Ok(([(CONTENT_TYPE, asset.kind)], asset.bytes).into_response())
}

/// The JSON of a request.
fn read<T: DeserializeOwned>(body: &Bytes) -> Result<T, Failed> {
    serde_json::from_slice(body).map_err(|error| Failed::bad(format!("the request cannot be read: {error}")))
}

/// A drawing that is asked for; `job` comes back in what is told of it.
#[derive(Debug, Deserialize)]
struct DrawRequest {
    #[serde(flatten)]
    wanted: Wanted,
    #[serde(default)]
    job: Value,
}

async fn draw_scene(State(Served { session, .. }): State<Served>, body: Bytes) -> Result<Json<Value>, Failed> {
    let DrawRequest { wanted, job } = read(&body)?;
    let progress = Progress::default();
    let (inner, seen) = (Arc::clone(&session), progress.clone());
    let drawing = session.queue.run(move |stop| draw(&inner, &wanted, stop, seen));
    tokio::pin!(drawing);
    let begun = Instant::now();
    let drawn = loop {
        match tokio::time::timeout(TELL, &mut drawing).await {
            Ok(drawn) => break drawn,
            Err(_) => {
                let (step, paint) = progress.step();
                let ms = begun.elapsed().as_millis() as u64;
                session.tell("step", &json!({ "job": job, "step": step, "paint": paint, "ms": ms }));
            }
        }
    };
    drawn.map_err(Failed::fault)?.map(Json).map_err(Failed::bad)
}

/// What stands behind the question mark of an address.
type Words = Query<Vec<(String, String)>>;

fn word<'a>(words: &'a [(String, String)], name: &str) -> &'a str {
    words.iter().find(|(known, _)| known == name).map_or("", |(_, value)| value)
}

/// Which layers are not shown: `hide=0,3`.
fn hidden(words: &[(String, String)]) -> Result<Vec<usize>, Failed> {
    let numbers = word(words, "hide").split(',').map(str::trim).filter(|number| !number.is_empty());
    let parsed: Result<Vec<usize>, _> = numbers.map(str::parse).collect();
    parsed.map_err(|_| Failed::bad("`hide` lists numbers of layers, as in 0,3"))
}

/// An answer that stays as it is, for names of pictures are never used again.
fn kept(kind: &'static str, body: impl Into<Body>) -> Response {
    let headers = [(CONTENT_TYPE, kind), (CACHE_CONTROL, "private, max-age=3600, immutable")];
    (headers, body.into()).into_response()
}

async fn picture(
    State(Served { session, .. }): State<Served>,
    Path(name): Path<String>,
    Query(words): Words,
) -> Result<Response, Failed> {
    let id = name.strip_suffix(".svg").ok_or_else(|| Failed::new(StatusCode::NOT_FOUND, "pictures end in .svg"))?;
    let picture = session.picture(id).ok_or_else(Failed::unknown)?;
    let hidden = hidden(&words)?;
    let svg = match picture.svg.get() {
        Some(svg) if hidden.is_empty() => Bytes::from_owner(Arc::clone(svg)),
        _ => session.brushes.run(move |_| without(&picture, &hidden)).await.map_err(Failed::fault)?.into(),
    };
    Ok(kept("image/svg+xml", svg))
}

async fn tile(
    State(Served { session, .. }): State<Served>,
    Path((id, z, x, y)): Path<(String, String, String, String)>,
    Query(words): Words,
) -> Result<Response, Failed> {
    let picture = session.picture(&id).ok_or_else(Failed::unknown)?;
    let hidden = hidden(&words)?;
    let none = || Failed::new(StatusCode::NOT_FOUND, "the picture has no such tile");
    let numbers = (z.parse().ok()).zip(x.parse().ok()).zip(y.strip_suffix(".png").and_then(|y| y.parse().ok()));
    let ((z, x), y) = numbers.ok_or_else(none)?;
    let drawn = session.brushes.run(move |stop| match stop.is_asked() {
        true => None,
        false => tiles::tile(&picture, z, [x, y], &hidden),
    });
    let png = drawn.await.map_err(Failed::fault)?.ok_or_else(none)?.map_err(Failed::fault)?;
    Ok(kept("image/png", png))
}

async fn thumb(
    State(Served { session, .. }): State<Served>,
    Path(id): Path<String>,
    Query(words): Words,
) -> Result<Response, Failed> {
    let picture = session.picture(&id).ok_or_else(Failed::unknown)?;
    let hidden = hidden(&words)?;
    let size = match word(&words, "size") {
        "" => Some(256),
        size => size.parse().ok(),
    };
    let size = size.ok_or_else(|| Failed::bad("`size` is a number of pixels"))?;
    let png = session.brushes.run(move |_| tiles::thumb(&picture, size, &hidden));
    Ok(kept("image/png", png.await.map_err(Failed::fault)?.map_err(Failed::fault)?))
}

async fn metrics(State(Served { session, .. }): State<Served>, Path(id): Path<String>) -> Result<Json<Value>, Failed> {
    let picture = session.picture(&id).ok_or_else(Failed::unknown)?;
    let limits = session.settings.limits.clone();
    let measured = session.queue.run(move |stop| measure(&picture, &limits, stop)).await.map_err(Failed::fault)?;
    measured.map(Json).map_err(|words| Failed::new(StatusCode::UNPROCESSABLE_ENTITY, words))
}

/// A picture that is to be saved.
#[derive(Debug, Deserialize)]
struct SaveRequest {
    #[serde(flatten)]
    wanted: Wanted,
    kind: String,
}

async fn save_picture(State(Served { session, .. }): State<Served>, body: Bytes) -> Result<Json<Value>, Failed> {
    let SaveRequest { wanted, kind } = read(&body)?;
    let kind = match &*kind {
        "svg" => Kind::Svg,
        "png" => Kind::Png,
        "pdf" => Kind::Pdf,
        _ => return Err(Failed::bad("pictures are saved as svg, png or pdf")),
    };
    let inner = Arc::clone(&session);
    let saved = session.queue.run(move |stop| save(&inner, &wanted, kind, stop)).await.map_err(Failed::fault)?;
    let path = saved.map_err(|words| Failed::new(StatusCode::UNPROCESSABLE_ENTITY, words))?;
    Ok(Json(json!({ "path": path.to_string_lossy() })))
}

async fn write_params(State(Served { session, .. }): State<Served>, body: Bytes) -> Result<Json<Value>, Failed> {
    let writing: Writing = read(&body)?;
    let inner = Arc::clone(&session);
    let written = session.queue.run(move |stop| write_back(&inner, &writing, stop)).await.map_err(Failed::fault)?;
    let written = written.map_err(|refused| match refused {
        Refused::Changed(words) => Failed::new(StatusCode::CONFLICT, words),
        Refused::Fault(words) => Failed::new(StatusCode::UNPROCESSABLE_ENTITY, words),
        Refused::Io(words) => Failed::fault(words),
    })?;
    Ok(Json(json!({ "written": written })))
}

/// The SVG of a picture without some of its layers.
fn without(picture: &Picture, hidden: &[usize]) -> Vec<u8> {
    let layers = picture.drawing.layers.iter().enumerate().filter(|(i, _)| !hidden.contains(i));
    let drawing = crate::drawing::Drawing {
        page: picture.drawing.page.clone(),
        layers: layers.map(|(_, layer)| layer.clone()).collect(),
    };
    // Memory takes all that is written.
    written(&drawing).unwrap_or_default()
}

async fn events(State(Served { session, .. }): State<Served>) -> Response {
    let events = UnboundedReceiverStream::new(session.listen());
    let events = events.map(|event| Ok::<_, Infallible>(Event::default().event(event.name).data(event.data)));
    Sse::new(events).keep_alive(KeepAlive::new().interval(SIGN)).into_response()
}
