//! The calls and messages of `proto/indigo.proto`.
#![allow(clippy::pedantic, missing_docs, reason = "generated")]

tonic::include_proto!("indigo.net.v1");
