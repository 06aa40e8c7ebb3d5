//! Both sides prove the shared key to each other, and encrypt all they say.
//!
//! From the key follow two key pairs (Ed25519), one for masters and one for slaves; each side shows a certificate that
//! it has signed itself, and the other looks for the public key that it expects in it. So a handshake of TLS 1.3 succeeds
//! only between holders of the shared key, in their roles, and what was recorded earlier cannot be read later, not even
//! with the key. Names and dates of the certificates mean nothing.

use crate::key::Key;
use rcgen::{CertificateParams, DnType, KeyPair, PublicKeyData as _, SerialNumber};
use rustls::client::danger::{HandshakeSignatureValid, ServerCertVerified, ServerCertVerifier};
use rustls::crypto::{CryptoProvider, ring, verify_tls13_signature};
use rustls::pki_types::{CertificateDer, PrivateKeyDer, PrivatePkcs8KeyDer, ServerName, UnixTime};
use rustls::server::danger::{ClientCertVerified, ClientCertVerifier};
use rustls::server::{NoServerSessionStorage, ParsedCertificate};
use rustls::version::TLS13;
use rustls::{
    CertificateError, ClientConfig, DigitallySignedStruct, DistinguishedName, Error, ServerConfig,
    SignatureScheme,
};
use std::sync::Arc;

/// The name of all masters, whatever their machines are called.
pub const SERVER_NAME: &str = "indigo";
/// HTTP/2.
const ALPN: &[u8] = b"h2";
/// What comes before the 32 bytes of a private key of Ed25519 in PKCS#8 (RFC 8410, section 7).
const PKCS8: [u8; 16] = [0x30, 0x2e, 2, 1, 0, 0x30, 5, 6, 3, 0x2b, 0x65, 0x70, 4, 0x22, 4, 0x20];

/// A side of the connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    Master,
    Slave,
}

impl Role {
    /// What its key pair is derived for; never to be changed.
    const fn purpose(self) -> &'static str {
        match self {
            Self::Master => "indigo network rendering v1 master",
            Self::Slave => "indigo network rendering v1 slave",
        }
    }

    fn key_pair(self, key: &Key) -> Result<KeyPair, rcgen::Error> {
        let pkcs8 = [&PKCS8[..], &key.derive(self.purpose())].concat();
        KeyPair::try_from(&PrivatePkcs8KeyDer::from(pkcs8))
    }
}

/// Why a handshake has failed, in words that help: `otherwise` where it is for want of the key.
pub fn unproved(error: &std::io::Error, otherwise: &str) -> String {
    let cause = error.get_ref().and_then(|cause| cause.downcast_ref::<Error>());
    match cause {
        Some(Error::InvalidMessage(_)) => {
            "it does not encrypt what it says, as who has the key does".to_owned()
        }
        Some(Error::InvalidCertificate(_) | Error::AlertReceived(_)) => otherwise.to_owned(),
        _ => format!("{otherwise}: {error}"),
    }
}

/// What a side shows.
struct Shown {
    certificate: CertificateDer<'static>,
    private: PrivateKeyDer<'static>,
}

fn shown(role: Role, key: &Key) -> Result<Shown, Error> {
    let failed = |error: rcgen::Error| Error::General(format!("no certificate: {error}"));
    let pair = role.key_pair(key).map_err(failed)?;
    let mut parameters = CertificateParams::new(vec![SERVER_NAME.to_owned()]).map_err(failed)?;
    parameters.distinguished_name.push(DnType::CommonName, "Indigo network rendering");
    // All certificates of a key are the same to the last byte.
    parameters.serial_number = Some(SerialNumber::from(1u64));
    let certificate = parameters.self_signed(&pair).map_err(failed)?.der().clone();
    Ok(Shown { certificate, private: PrivatePkcs8KeyDer::from(pair.serialize_der()).into() })
}

/// Expects the public key that the other side has from the shared key.
#[derive(Debug)]
struct Verifier {
    public: Vec<u8>,
    provider: Arc<CryptoProvider>,
}

impl Verifier {
    fn new(role: Role, key: &Key, provider: &Arc<CryptoProvider>) -> Result<Arc<Self>, Error> {
        let pair = role.key_pair(key).map_err(|error| Error::General(format!("no key pair: {error}")))?;
        Ok(Arc::new(Self { public: pair.subject_public_key_info(), provider: Arc::clone(provider) }))
    }

    fn check(&self, certificate: &CertificateDer<'_>) -> Result<(), Error> {
        let parsed = ParsedCertificate::try_from(certificate)?;
        if parsed.subject_public_key_info().as_ref() == self.public {
            Ok(())
        } else {
            Err(CertificateError::ApplicationVerificationFailure.into())
        }
    }

    fn check_signature(
        &self,
        message: &[u8],
        certificate: &CertificateDer<'_>,
        signature: &DigitallySignedStruct,
    ) -> Result<HandshakeSignatureValid, Error> {
        verify_tls13_signature(
            message,
            certificate,
            signature,
            &self.provider.signature_verification_algorithms,
        )
    }
}

/// No other version is spoken.
fn no_tls12() -> Error {
    Error::General("TLS 1.3 is expected".to_owned())
}

impl ServerCertVerifier for Verifier {
    fn verify_server_cert(
        &self,
        end_entity: &CertificateDer<'_>,
        _intermediates: &[CertificateDer<'_>],
        _server_name: &ServerName<'_>,
        _ocsp_response: &[u8],
        _now: UnixTime,
    ) -> Result<ServerCertVerified, Error> {
        self.check(end_entity).map(|()| ServerCertVerified::assertion())
    }

    fn verify_tls12_signature(
        &self,
        _: &[u8],
        _: &CertificateDer<'_>,
        _: &DigitallySignedStruct,
    ) -> Result<HandshakeSignatureValid, Error> {
        Err(no_tls12())
    }

    fn verify_tls13_signature(
        &self,
        message: &[u8],
        cert: &CertificateDer<'_>,
        dss: &DigitallySignedStruct,
    ) -> Result<HandshakeSignatureValid, Error> {
        self.check_signature(message, cert, dss)
    }

    fn supported_verify_schemes(&self) -> Vec<SignatureScheme> {
        vec![SignatureScheme::ED25519]
    }
}

impl ClientCertVerifier for Verifier {
    fn root_hint_subjects(&self) -> &[DistinguishedName] {
        &[]
    }

    fn verify_client_cert(
        &self,
        end_entity: &CertificateDer<'_>,
        _intermediates: &[CertificateDer<'_>],
        _now: UnixTime,
    ) -> Result<ClientCertVerified, Error> {
        self.check(end_entity).map(|()| ClientCertVerified::assertion())
    }

    fn verify_tls12_signature(
        &self,
        _: &[u8],
        _: &CertificateDer<'_>,
        _: &DigitallySignedStruct,
    ) -> Result<HandshakeSignatureValid, Error> {
        Err(no_tls12())
    }

    fn verify_tls13_signature(
        &self,
        message: &[u8],
        cert: &CertificateDer<'_>,
        dss: &DigitallySignedStruct,
    ) -> Result<HandshakeSignatureValid, Error> {
        self.check_signature(message, cert, dss)
    }

    fn supported_verify_schemes(&self) -> Vec<SignatureScheme> {
        vec![SignatureScheme::ED25519]
    }
}

/// What a master with this key accepts connections by.
///
/// # Errors
/// Where the cryptography fails, which it does not.
pub fn server(key: &Key) -> Result<Arc<ServerConfig>, Error> {
    let provider = Arc::new(ring::default_provider());
    let Shown { certificate, private } = shown(Role::Master, key)?;
    let mut config = ServerConfig::builder_with_provider(Arc::clone(&provider))
        .with_protocol_versions(&[&TLS13])?
        .with_client_cert_verifier(Verifier::new(Role::Slave, key, &provider)?)
        .with_single_cert(vec![certificate], private)?;
    config.alpn_protocols = vec![ALPN.to_vec()];
    // Each connection proves the key anew.
    config.session_storage = Arc::new(NoServerSessionStorage {});
    config.send_tls13_tickets = 0;
    Ok(Arc::new(config))
}

/// What a slave with this key connects by.
///
/// # Errors
/// As [`server`].
pub fn client(key: &Key) -> Result<Arc<ClientConfig>, Error> {
    let provider = Arc::new(ring::default_provider());
    let Shown { certificate, private } = shown(Role::Slave, key)?;
    let mut config = ClientConfig::builder_with_provider(Arc::clone(&provider))
        .with_protocol_versions(&[&TLS13])?
        .dangerous()
        .with_custom_certificate_verifier(Verifier::new(Role::Master, key, &provider)?)
        .with_client_auth_cert(vec![certificate], private)?;
    config.alpn_protocols = vec![ALPN.to_vec()];
    Ok(Arc::new(config))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rustls::{ClientConnection, ServerConnection};

    /// What a handshake in memory ends with, for client and server.
    fn handshake(client: &Arc<ClientConfig>, server: &Arc<ServerConfig>) -> Result<(), Error> {
        let name = ServerName::try_from(SERVER_NAME).expect("a name");
        let mut client = ClientConnection::new(Arc::clone(client), name)?;
        let mut server = ServerConnection::new(Arc::clone(server))?;
        while client.is_handshaking() || server.is_handshaking() {
            let mut wire = vec![];
            client.write_tls(&mut wire).expect("memory");
            let mut rest = &wire[..];
            while !rest.is_empty() {
                server.read_tls(&mut rest).expect("memory");
                server.process_new_packets()?;
            }
            let mut wire = vec![];
            server.write_tls(&mut wire).expect("memory");
            let mut rest = &wire[..];
            while !rest.is_empty() {
                client.read_tls(&mut rest).expect("memory");
                client.process_new_packets()?;
            }
        }
        Ok(())
    }

    #[test]
    fn only_holders_of_the_same_key_meet_and_in_their_roles() {
        let (key, other) = (Key::random().unwrap(), Key::random().unwrap());
        assert_eq!(handshake(&client(&key).unwrap(), &server(&key).unwrap()), Ok(()));
        assert!(handshake(&client(&key).unwrap(), &server(&other).unwrap()).is_err());
        assert!(handshake(&client(&other).unwrap(), &server(&key).unwrap()).is_err());
    }

    /// A client that takes every master for the right one: the master must refuse it by itself.
    #[test]
    fn a_master_does_not_rely_on_slaves_to_refuse() {
        let (key, other) = (Key::random().unwrap(), Key::random().unwrap());
        let provider = Arc::new(ring::default_provider());
        let trusting = |shown: Option<Shown>| {
            let builder = ClientConfig::builder_with_provider(Arc::clone(&provider))
                .with_protocol_versions(&[&TLS13])
                .unwrap()
                .dangerous()
                .with_custom_certificate_verifier(Verifier::new(Role::Master, &key, &provider).unwrap());
            Arc::new(match shown {
                Some(s) => builder.with_client_auth_cert(vec![s.certificate], s.private).unwrap(),
                None => builder.with_no_client_auth(),
            })
        };
        let server = server(&key).unwrap();
        assert_eq!(handshake(&trusting(Some(shown(Role::Slave, &key).unwrap())), &server), Ok(()));
        assert!(handshake(&trusting(Some(shown(Role::Slave, &other).unwrap())), &server).is_err());
        // A slave's proof is not a master's, and the other way round.
        assert!(handshake(&trusting(Some(shown(Role::Master, &key).unwrap())), &server).is_err());
        assert!(handshake(&trusting(None), &server).is_err());
    }

    #[test]
    fn certificates_of_a_key_are_always_the_same() {
        let key = Key::random().unwrap();
        for role in [Role::Master, Role::Slave] {
            assert_eq!(shown(role, &key).unwrap().certificate, shown(role, &key).unwrap().certificate);
        }
    }
}
