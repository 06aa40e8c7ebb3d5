//! Calls to a master, and what becomes of a visit by their answers.

use crate::limits::ANSWER;
use crate::plain::plain;
use crate::proto::farm_client::FarmClient;
use std::error::Error as _;
use std::future::Future;
use tokio::time::timeout;
use tonic::transport::Channel;
use tonic::{Code, Status};

/// Makes calls to a master over one connection.
pub type Client = FarmClient<Channel>;

/// How a visit ends.
pub enum Outcome {
    /// The slave was told to stop.
    Stopped,
    /// The master has ended the render.
    Finished,
    /// The master wants nothing of this slave.
    Refused(String),
    /// The connection is lost, or was never there.
    Lost(String),
    /// The renderer has a fault.
    Broken(String),
}

/// What a master's answer means, if it is none.
pub fn refusal(status: &Status) -> Outcome {
    let message = match status.message() {
        "" => status.code().description().to_owned(),
        message => plain(message),
    };
    match status.code() {
        Code::FailedPrecondition | Code::AlreadyExists | Code::InvalidArgument | Code::Unimplemented => {
            Outcome::Refused(format!("the master refuses: {message}"))
        }
        _ if is_refused(status) => Outcome::Refused(format!("the master refuses: {message}")),
        _ => Outcome::Lost(format!("the connection to the master is lost: {message}")),
    }
}

/// Whether it is the master that wants no such upload. Connections that end for too much traffic have a like code, and an
/// error behind it.
pub fn is_refused(status: &Status) -> bool {
    matches!(status.code(), Code::InvalidArgument | Code::ResourceExhausted) && status.source().is_none()
}

/// A short call's answer.
pub async fn answer<T>(call: impl Future<Output = Result<tonic::Response<T>, Status>>) -> Result<T, Outcome> {
    within_time(call).await?.map_err(|status| refusal(&status))
}

/// The same of the first call over a connection to a place, where something else than a master may be.
pub async fn first_answer<T>(
    call: impl Future<Output = Result<tonic::Response<T>, Status>>,
    place: &str,
    has_key: bool,
) -> Result<T, Outcome> {
    within_time(call).await?.map_err(|status| match status.code() {
        // What those codes tell of is mostly in the library's words.
        Code::Internal | Code::Unknown | Code::Unimplemented => {
            let expected = if has_key { "a render master" } else { "a render master without a key" };
            let why = plain(status.message());
            Outcome::Lost(format!("what is at {place} does not answer as {expected} does ({why})"))
        }
        _ => refusal(&status),
    })
}

async fn within_time<T>(
    call: impl Future<Output = Result<tonic::Response<T>, Status>>,
) -> Result<Result<T, Status>, Outcome> {
    let answered = timeout(ANSWER, call).await;
    answered
        .map(|answer| answer.map(tonic::Response::into_inner))
        .map_err(|_| Outcome::Lost("the master does not answer".to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::proto::UploadPart;
    use crate::slave::Connector;
    use std::io::{Read, Result, Write};
    use std::net::{TcpListener, TcpStream};

    /// Numbers of HTTP/2 (RFC 9113, sections 6 and 7).
    const HEADERS: u8 = 1;
    const SETTINGS: u8 = 4;
    const GOAWAY: u8 = 7;
    const ENHANCE_YOUR_CALM: u32 = 11;
    /// What a client says first.
    const PREFACE: usize = 24;

    fn send(stream: &mut TcpStream, kind: u8, content: &[u8]) -> Result<()> {
        let length = u8::try_from(content.len()).expect("a short frame");
        stream.write_all(&[&[0, 0, length, kind, 0, 0, 0, 0, 0], content].concat())
    }

    /// Answers the first call over a connection by ending that for too much traffic.
    fn end_at_first_call(mut stream: TcpStream) -> Result<()> {
        stream.read_exact(&mut [0; PREFACE])?;
        send(&mut stream, SETTINGS, &[])?;
        let mut head = [0; 9];
        while head[3] != HEADERS {
            stream.read_exact(&mut head)?;
            let length = u32::from_be_bytes([0, head[0], head[1], head[2]]);
            stream.read_exact(&mut vec![0; length as usize])?;
        }
        // None of the calls was looked at.
        send(&mut stream, GOAWAY, &[[0; 4], ENHANCE_YOUR_CALM.to_be_bytes()].concat())?;
        stream.read_to_end(&mut vec![]).map(drop)
    }

    /// What such an upload holds is to be sent again, not thrown away.
    #[test]
    fn a_connection_that_ends_for_too_much_traffic_refuses_nothing() {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
        let port = listener.local_addr().expect("it is bound").port();
        // The client may close it in whatever way.
        let server =
            std::thread::spawn(move || drop(listener.accept().map(|(tcp, _)| end_at_first_call(tcp))));
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("threads");
        let status = runtime.block_on(async {
            let connector = Connector::new(None).expect("it needs nothing");
            let mut client = connector.connect("127.0.0.1", port).await.expect("it listens");
            client.upload(tokio_stream::iter([UploadPart { part: None }])).await.expect_err("it is fed up")
        });
        assert_eq!(status.code(), Code::ResourceExhausted, "as a refusal's: {status}");
        assert!(!is_refused(&status), "{status:?}");
        assert!(matches!(refusal(&status), Outcome::Lost(_)), "it is tried again");
        drop(runtime);
        server.join().expect("it has ended");
    }
}
