//! Connections that end when the other side has said nothing for too long.

use std::future::Future as _;
use std::io::{self, ErrorKind};
use std::pin::Pin;
use std::task::{Context, Poll, ready};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::sync::oneshot;
use tokio::time::{Instant, Sleep, sleep};

/// A stream of which each read must bring something within a time. A peer that is asked by HTTP/2 whether it is still
/// there answers, so only what is dead, or no such peer, is silent.
pub struct Watched<S> {
    stream: S,
    patience: Duration,
    alarm: Pin<Box<Sleep>>,
    /// What must come within the time: something to read, or else room to write, which is what answers take.
    awaits: Awaited,
    /// Its place among those that are counted, which it may have to give to another.
    place: Option<oneshot::Receiver<()>>,
    has_lost_place: bool,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Awaited {
    Words,
    Answers,
}

impl<S> Watched<S> {
    /// From now on.
    pub fn new(stream: S, patience: Duration) -> Self {
        let alarm = Box::pin(sleep(patience));
        Self { stream, patience, alarm, awaits: Awaited::Words, place: None, has_lost_place: false }
    }

    /// The same for a peer that asks, and then may listen for long without a word: between answers, or parts of one, there must
    /// be no more than the time, however often it says a word of a question that never ends. It ends, too, when the other end
    /// of `place` is dropped.
    pub fn answered(stream: S, patience: Duration, place: oneshot::Receiver<()>) -> Self {
        Self { awaits: Awaited::Answers, place: Some(place), ..Self::new(stream, patience) }
    }

    fn rewind(&mut self) {
        let next = Instant::now() + self.patience;
        self.alarm.as_mut().reset(next);
    }

    /// Fails once its place is another's, also where there is always something to read and room to write.
    fn has_place(&mut self, cx: &mut Context<'_>) -> io::Result<()> {
        if self.place.as_mut().is_some_and(|place| Pin::new(place).poll(cx).is_ready()) {
            // Asked again the channel would have no answer.
            self.place = None;
            self.has_lost_place = true;
        }
        if self.has_lost_place { Err(io::Error::other("another has its place")) } else { Ok(()) }
    }

    /// What becomes of a call that has to wait.
    fn pending<T>(&mut self, cx: &mut Context<'_>) -> Poll<io::Result<T>> {
        ready!(self.alarm.as_mut().poll(cx));
        Poll::Ready(Err(io::Error::new(ErrorKind::TimedOut, "the other side is silent")))
    }

    fn written(&mut self, cx: &mut Context<'_>, written: Poll<io::Result<usize>>) -> Poll<io::Result<usize>> {
        if self.awaits == Awaited::Answers {
            if written.is_pending() {
                return self.pending(cx);
            }
            self.rewind();
        }
        written
    }
}

impl<S: AsyncRead + Unpin> AsyncRead for Watched<S> {
    fn poll_read(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buf: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        self.has_place(cx)?;
        match Pin::new(&mut self.stream).poll_read(cx, buf) {
            Poll::Ready(read) => {
                if self.awaits == Awaited::Words {
                    self.rewind();
                }
                Poll::Ready(read)
            }
            Poll::Pending => self.pending(cx),
        }
    }
}

impl<S: AsyncWrite + Unpin> AsyncWrite for Watched<S> {
    fn poll_write(mut self: Pin<&mut Self>, cx: &mut Context<'_>, buf: &[u8]) -> Poll<io::Result<usize>> {
        self.has_place(cx)?;
        let written = Pin::new(&mut self.stream).poll_write(cx, buf);
        self.written(cx, written)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        bufs: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        self.has_place(cx)?;
        let written = Pin::new(&mut self.stream).poll_write_vectored(cx, bufs);
        self.written(cx, written)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(cx)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(cx)
    }
}
