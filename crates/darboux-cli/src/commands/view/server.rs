//! The web server of the viewer: serves the page and the model to browsers on this machine.
//!
//! It listens on the loopback address only. A request must name that address in `Host` and begin its path
//! with a random secret, so that pages of other origins cannot read the model. Nothing that a client sends is
//! stored: request bodies are not read, headers have a maximum size, and every connection has a time limit
//! and carries one request.

use std::convert::Infallible;
use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener as StdListener};
use std::sync::Arc;
use std::thread;
use std::time::Duration;

use darboux_io::system_reason;
use http_body_util::Full;
use hyper::body::{Bytes, Incoming};
use hyper::header::{CACHE_CONTROL, CONTENT_TYPE, HOST, HeaderValue, X_CONTENT_TYPE_OPTIONS};
use hyper::http::request::Parts;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper::{Method, Request, Response, StatusCode};
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{Semaphore, oneshot};
use tokio::{runtime, task, time};

use super::model::ServedModel;
use super::page::Page;

/// More connections than this at the same time are closed at once.
const MAX_CONNECTIONS: usize = 1024;
/// The maximum size in bytes of a request's line and headers.
const MAX_HEAD: usize = 16 << 10;
/// The maximum number of headers.
const MAX_HEADERS: usize = 64;
/// The time in which the headers must arrive.
const HEAD_TIMEOUT: Duration = Duration::from_secs(10);
/// The time after which a connection is closed.
const CONNECTION_TIMEOUT: Duration = Duration::from_secs(120);
/// The pause after the system refuses a connection, for example because too many files are open.
const ACCEPT_PAUSE: Duration = Duration::from_millis(100);

/// A server on a random port of the loopback address.
pub struct Server {
    listener: StdListener,
    served: Arc<ServedFiles>,
}

/// The models that the page shows.
pub struct ServedModels {
    pub model: Option<ServedModel>,
    /// The high model that is baked onto the other one.
    pub high: Option<ServedModel>,
}

impl ServedModels {
    /// The model below an address.
    fn at(&self, address: &str) -> Option<&ServedModel> {
        if address == HIGH { self.high.as_ref() } else { self.model.as_ref() }
    }
}

/// The addresses of the models.
const MODEL: &str = "model";
const HIGH: &str = "high";

/// What is served, and to whom.
struct ServedFiles {
    page: Page,
    models: ServedModels,
    /// The server's address, as browsers send it in `Host`.
    host: String,
    secret: String,
}

/// Status, media type and body of a response.
type ResponseParts = (StatusCode, &'static str, Vec<u8>);

const TEXT: &str = "text/plain; charset=utf-8";

impl Server {
    /// Opens a port. Errors: the system refuses one.
    pub fn start(page: Page, models: ServedModels, secret: String) -> Result<Self, String> {
        let failed = |error: io::Error| format!("no port can be opened: {}", system_reason(&error));
        let listener = StdListener::bind(SocketAddr::from((Ipv4Addr::LOCALHOST, 0))).map_err(failed)?;
        listener.set_nonblocking(true).map_err(failed)?;
        let host = listener.local_addr().map_err(failed)?.to_string();
        Ok(Self { listener, served: Arc::new(ServedFiles { page, models, host, secret }) })
    }

    /// The address of the page.
    pub fn address(&self) -> String {
        let ServedFiles { host, secret, models, .. } = &*self.served;
        let queries = [MODEL, HIGH].into_iter().filter_map(|address| {
            let name = models.at(address)?.names().into_iter().next()?;
            Some(format!("{address}={}", percent_encoded(&name)))
        });
        let queries = queries.collect::<Vec<_>>().join("&");
        let mark = if queries.is_empty() { "" } else { "?" };
        format!("http://{host}/{secret}/{mark}{queries}")
    }

    /// Serves until the process ends. Errors: the system refuses what the server needs.
    pub fn run(self) -> Result<Infallible, String> {
        let failed = |error: io::Error| format!("the server cannot run: {}", system_reason(&error));
        let runtime = runtime::Builder::new_current_thread().enable_all().build().map_err(failed)?;
        runtime.block_on(async {
            let listener = TcpListener::from_std(self.listener).map_err(failed)?;
            let slots = Arc::new(Semaphore::new(MAX_CONNECTIONS));
            loop {
                let Ok((stream, _)) = listener.accept().await else {
                    time::sleep(ACCEPT_PAUSE).await;
                    continue;
                };
                // Dropping the stream closes the connection.
                let Ok(slot) = slots.clone().try_acquire_owned() else { continue };
                let served = self.served.clone();
                task::spawn(async move {
                    served.serve(stream).await;
                    drop(slot);
                });
            }
        })
    }
}

impl ServedFiles {
    /// Responds to the one request of a connection.
    async fn serve(self: Arc<Self>, stream: TcpStream) {
        let service = service_fn(move |request| {
            let served = self.clone();
            async move { Ok::<_, Infallible>(served.respond(request).await) }
        });
        let connection = http1::Builder::new()
            .timer(TokioTimer::new())
            .header_read_timeout(HEAD_TIMEOUT)
            .max_buf_size(MAX_HEAD)
            .max_headers(MAX_HEADERS)
            .keep_alive(false)
            .serve_connection(TokioIo::new(stream), service);
        let _client_may_be_gone = time::timeout(CONNECTION_TIMEOUT, connection).await;
    }

    async fn respond(self: Arc<Self>, request: Request<Incoming>) -> Response<Full<Bytes>> {
        let (head, _unread_body) = request.into_parts();
        let (status, media_type, body) = self.read(Arc::new(head)).await;
        let mut response = Response::new(Full::new(Bytes::from(body)));
        *response.status_mut() = status;
        let headers = response.headers_mut();
        headers.insert(CONTENT_TYPE, HeaderValue::from_static(media_type));
        headers.insert(CACHE_CONTROL, HeaderValue::from_static("no-store"));
        headers.insert(X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
        response
    }

    /// Reads the files for a response on another thread, so that other connections go on; on this one where
    /// the system refuses a thread.
    async fn read(self: Arc<Self>, head: Arc<Parts>) -> ResponseParts {
        let (sender, receiver) = oneshot::channel();
        let (site, head_of_thread) = (self.clone(), head.clone());
        let read = move || {
            let _client_may_be_gone = sender.send(site.response_parts(&head_of_thread));
        };
        match thread::Builder::new().spawn(read) {
            Ok(_) => receiver.await.unwrap_or_else(|_| {
                (StatusCode::INTERNAL_SERVER_ERROR, TEXT, b"the request failed".to_vec())
            }),
            Err(_) => self.response_parts(&head),
        }
    }

    fn response_parts(&self, head: &Parts) -> ResponseParts {
        // A request with two hosts is malformed (RFC 9112, section 3.2).
        let mut hosts = head.headers.get_all(HOST).iter().map(HeaderValue::as_bytes);
        let host = hosts.next().filter(|_| hosts.next().is_none());
        let path = head.uri.path();
        let below = path.strip_prefix('/').and_then(|path| path.strip_prefix(self.secret.as_str()));
        let Some(name) =
            below.and_then(|below| below.strip_prefix('/')).filter(|_| host == Some(self.host.as_bytes()))
        else {
            return (
                StatusCode::FORBIDDEN,
                TEXT,
                b"use the whole address that darboux view printed".to_vec(),
            );
        };
        if !matches!(head.method, Method::GET | Method::HEAD) {
            return (StatusCode::METHOD_NOT_ALLOWED, TEXT, b"only GET is supported".to_vec());
        }
        match name {
            "" => self.page_file("index.html"),
            MODEL | HIGH => self.model_names(name),
            name => match name.split_once('/') {
                Some((address @ (MODEL | HIGH), index)) => self.model_file(address, index),
                _ => self.page_file(name),
            },
        }
    }

    fn page_file(&self, name: &str) -> ResponseParts {
        match self.page.read(name) {
            Some((media_type, bytes)) => (StatusCode::OK, media_type, bytes),
            None => not_found("there is no such file"),
        }
    }

    /// The names of the model's files as a JSON array.
    fn model_names(&self, address: &str) -> ResponseParts {
        let names = self.models.at(address).map(|model| serde_json::to_vec(&model.names()));
        match names {
            Some(Ok(names)) => (StatusCode::OK, "application/json", names),
            _ => not_found("darboux view was started without this model"),
        }
    }

    /// The file with an index in that array.
    fn model_file(&self, address: &str, index: &str) -> ResponseParts {
        let read =
            self.models.at(address).zip(index.parse().ok()).and_then(|(model, index)| model.read(index));
        match read {
            Some(Ok(bytes)) => (StatusCode::OK, "application/octet-stream", bytes),
            Some(Err(sentence)) => (StatusCode::UNPROCESSABLE_ENTITY, TEXT, sentence.into_bytes()),
            None => not_found("there is no such file"),
        }
    }
}

fn not_found(sentence: &str) -> ResponseParts {
    (StatusCode::NOT_FOUND, TEXT, sentence.into())
}

/// Encodes a text for the query of an address: every byte except letters, digits and `.-_` becomes %XX.
fn percent_encoded(text: &str) -> String {
    let encode = |byte: u8| match byte {
        b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'.' | b'-' | b'_' => char::from(byte).to_string(),
        _ => format!("%{byte:02X}"),
    };
    text.bytes().map(encode).collect()
}
