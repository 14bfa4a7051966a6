//! Serves the page and the model to this machine.

use std::io;
use std::net::{Ipv4Addr, SocketAddr};

use tiny_http::{Header, Method, Request, Response};

use super::model::Model;
use super::page::Page;

/// A server on a random port of the loopback address, behind a secret in the path.
pub struct Server {
    inner: tiny_http::Server,
    page: Page,
    model: Option<Model>,
    /// The port's address, as browsers name it in `Host`.
    host: String,
    secret: String,
}

/// A status, a media type and a body.
type Answer = (u16, &'static str, Vec<u8>);

const TEXT: &str = "text/plain; charset=utf-8";

impl Server {
    /// Errors: no port can be opened.
    pub fn start(page: Page, model: Option<Model>, secret: String) -> Result<Self, String> {
        let inner = tiny_http::Server::http(SocketAddr::from((Ipv4Addr::LOCALHOST, 0)))
            .map_err(|error| format!("no port can be opened: {error}"))?;
        let host = inner.server_addr().to_string();
        Ok(Self { inner, page, model, host, secret })
    }

    /// Where the page is.
    pub fn address(&self) -> String {
        let Self { host, secret, model, .. } = self;
        let query =
            model.iter().flat_map(Model::names).take(1).map(|name| format!("?model={}", in_query(&name)));
        format!("http://{host}/{secret}/{}", query.collect::<String>())
    }

    /// Answers, for ever.
    pub fn run(&self) {
        for request in self.inner.incoming_requests() {
            let (status, kind, body) = self.answer(&request);
            let response =
                Response::from_data(body).with_status_code(status).with_chunked_threshold(usize::MAX);
            let headers = [
                ("Content-Type", kind),
                ("Cache-Control", "no-store"),
                ("X-Content-Type-Options", "nosniff"),
            ];
            let response = headers.into_iter().filter_map(header).fold(response, Response::with_header);
            let _gone_is_no_fault: io::Result<()> = request.respond(response);
        }
    }

    fn answer(&self, request: &Request) -> Answer {
        if !self.is_ours(request) {
            return (403, TEXT, b"the address that darboux view printed is needed, whole".to_vec());
        }
        if !matches!(request.method(), Method::Get | Method::Head) {
            return (405, TEXT, b"only GET".to_vec());
        }
        let path = request.url().split('?').next().unwrap_or_default();
        match path.get(self.secret.len() + 2..).unwrap_or_default() {
            "" => self.file("index.html"),
            "model" => self.names(),
            name => match name.strip_prefix("model/") {
                Some(at) => self.model(at),
                None => self.file(name),
            },
        }
    }

    /// Whether the request has the secret, and names this machine: another host that resolves to it is not meant.
    fn is_ours(&self, request: &Request) -> bool {
        let host = request.headers().iter().find(|header| header.field.equiv("Host"));
        let is_host = host.is_some_and(|header| header.value.as_str() == self.host);
        let below = request.url().strip_prefix('/').and_then(|url| url.strip_prefix(self.secret.as_str()));
        is_host && below.is_some_and(|below| below.starts_with('/'))
    }

    fn file(&self, name: &str) -> Answer {
        match self.page.read(name) {
            Some((kind, bytes)) => (200, kind, bytes),
            None => (404, TEXT, b"no such file".to_vec()),
        }
    }

    /// The names of the model's files, as a list in JSON.
    fn names(&self) -> Answer {
        let names = self.model.as_ref().map(|model| serde_json::to_vec(&model.names()));
        match names {
            Some(Ok(names)) => (200, "application/json", names),
            _ => (404, TEXT, b"no model was named".to_vec()),
        }
    }

    /// The file whose name is at a place of that list.
    fn model(&self, at: &str) -> Answer {
        let read = self.model.as_ref().zip(at.parse().ok()).and_then(|(model, at)| model.read(at));
        match read {
            Some(Ok(bytes)) => (200, "application/octet-stream", bytes),
            Some(Err(sentence)) => (422, TEXT, sentence.into_bytes()),
            None => (404, TEXT, b"no such file".to_vec()),
        }
    }
}

fn header((name, value): (&str, &str)) -> Option<Header> {
    Header::from_bytes(name, value).ok()
}

/// A text in the query of an address: all but letters, digits and a few signs as their bytes.
fn in_query(text: &str) -> String {
    let one = |byte: u8| match byte {
        b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'.' | b'-' | b'_' => char::from(byte).to_string(),
        _ => format!("%{byte:02X}"),
    };
    text.bytes().map(one).collect()
}
