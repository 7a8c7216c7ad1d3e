//! A virtual screen to open the editor's window on: Xvfb, and the few X11 requests that look at it and move
//! its mouse and keys. X Window System Protocol, version 11, and the XTEST extension (both X.Org).

use std::io::{Read, Write};
use std::os::linux::net::SocketAddrExt;
use std::os::unix::net::{SocketAddr, UnixStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// Width and height of the screen, pixels.
pub const SIZE: (u16, u16) = (1280, 900);

/// What a fake input event of XTEST does.
#[derive(Clone, Copy)]
#[repr(u8)]
pub enum Input {
    KeyDown = 2,
    KeyUp = 3,
    ButtonDown = 4,
    ButtonUp = 5,
    Move = 6,
}

/// An X server of its own, and a connection to it.
pub struct Screen {
    server: Child,
    /// Its name, for `DISPLAY`.
    pub name: String,
    stream: UnixStream,
    root: u32,
    xtest: u8,
}

impl Screen {
    /// Starts the server on a number that is free.
    pub fn start() -> Self {
        let size = format!("{}x{}x24", SIZE.0, SIZE.1);
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", &size, "-ac", "-nolisten", "tcp"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("this test needs Xvfb (package xvfb)");
        let mut number = String::new();
        let mut output = server.stdout.take().expect("piped");
        let mut byte = [0u8];
        while output.read(&mut byte).expect("Xvfb names its display") == 1 && byte[0] != b'\n' {
            number.push(char::from(byte[0]));
        }
        let number: u32 = number.trim().parse().expect("Xvfb started");
        // As root the server makes a file; others may get the abstract name only.
        let path = format!("/tmp/.X11-unix/X{number}");
        let mut stream = UnixStream::connect(&path)
            .or_else(|_| UnixStream::connect_addr(&SocketAddr::from_abstract_name(&path)?))
            .expect("the new server answers");
        // Little-endian, protocol 11.0, no authorisation.
        stream.write_all(&[b'l', 0, 11, 0, 0, 0, 0, 0, 0, 0, 0, 0]).expect("written");
        let mut head = [0u8; 8];
        stream.read_exact(&mut head).expect("the server replies");
        assert_eq!(head[0], 1, "the server refuses the connection");
        let mut setup = vec![0u8; 4 * usize::from(u16::from_le_bytes([head[6], head[7]]))];
        stream.read_exact(&mut setup).expect("the whole reply");
        let vendor = usize::from(u16::from_le_bytes([setup[16], setup[17]]));
        let formats = usize::from(setup[21]);
        let screens = 32 + vendor.next_multiple_of(4) + 8 * formats;
        let root = u32_at(&setup, screens);
        let mut screen = Self { server, name: format!(":{number}"), stream, root, xtest: 0 };
        let reply = screen.ask(98, 0, &[&[5, 0, 0, 0], b"XTEST\0\0\0".as_slice()].concat());
        assert_eq!(reply[8], 1, "the server lacks XTEST");
        screen.xtest = reply[9];
        screen
    }

    /// Gives the keyboard to the first window of the program, once there is one that is shown: there is no window
    /// manager to do it. Whether it has the keyboard now.
    pub fn focus(&mut self) -> bool {
        let reply = self.ask(15, 0, &self.root.to_le_bytes());
        let count = (reply.len() - 32) / 4;
        for k in 0..count {
            let window = u32_at(&reply, 32 + 4 * k);
            let geometry = self.ask(14, 0, &window.to_le_bytes());
            let width = u16::from_le_bytes([geometry[16], geometry[17]]);
            // The program's window is made before it is shown, and helper windows of the toolkit never are: giving
            // the keyboard to a hidden one is an error, without effect.
            let attributes = self.ask(3, 0, &window.to_le_bytes());
            let shown = attributes[26] == 2;
            if width > SIZE.0 / 2 && shown {
                self.send(42, 1, &[window.to_le_bytes(), [0; 4]].concat());
                let focus = self.ask(43, 0, &[]);
                return u32_at(&focus, 8) == window;
            }
        }
        false
    }

    /// Sends a key (X keycode) or button; for `Move` see [`Self::move_to`].
    pub fn input(&mut self, input: Input, detail: u8) {
        self.fake(input, detail, (0, 0));
    }

    /// Moves the mouse.
    pub fn move_to(&mut self, (x, y): (u16, u16)) {
        self.fake(Input::Move, 0, (x, y));
    }

    /// Presses a key and lets it go.
    pub fn key(&mut self, code: u8) {
        self.input(Input::KeyDown, code);
        self.input(Input::KeyUp, code);
    }

    fn fake(&mut self, input: Input, detail: u8, (x, y): (u16, u16)) {
        let mut body = [0u8; 32];
        body[0] = input as u8;
        body[1] = detail;
        body[8..12].copy_from_slice(&self.root.to_le_bytes());
        body[20..22].copy_from_slice(&x.to_le_bytes());
        body[22..24].copy_from_slice(&y.to_le_bytes());
        self.send(self.xtest, 2, &body);
        // A reply says that the server has done everything before.
        self.ask(43, 0, &[]);
    }

    /// What the screen shows: one blue, green, red, unused quadruple per pixel, row by row.
    pub fn picture(&mut self) -> Picture {
        let mut body = self.root.to_le_bytes().to_vec();
        body.extend([0, 0, 0, 0]);
        body.extend(SIZE.0.to_le_bytes());
        body.extend(SIZE.1.to_le_bytes());
        body.extend([255; 4]);
        let reply = self.ask(73, 2, &body);
        Picture(reply[32..].chunks_exact(4).map(|c| [c[2], c[1], c[0]]).collect())
    }

    fn send(&mut self, opcode: u8, detail: u8, body: &[u8]) {
        let words = u16::try_from(1 + body.len() / 4).expect("short requests");
        let mut bytes = vec![opcode, detail];
        bytes.extend(words.to_le_bytes());
        bytes.extend(body);
        self.stream.write_all(&bytes).expect("the server is there");
    }

    /// Sends a request and waits for its reply, with its head of 32 bytes. Errors and events are passed over.
    fn ask(&mut self, opcode: u8, detail: u8, body: &[u8]) -> Vec<u8> {
        self.send(opcode, detail, body);
        loop {
            let mut reply = vec![0u8; 32];
            self.stream.read_exact(&mut reply).expect("the server is there");
            match reply[0] {
                1 => {
                    let more = 4 * u32_at(&reply, 4) as usize;
                    reply.resize(32 + more, 0);
                    self.stream.read_exact(&mut reply[32..]).expect("the whole reply");
                    return reply;
                }
                // The error of the request itself would leave this waiting for ever.
                0 => assert_ne!(reply[10], opcode, "X error {} of request {opcode}", reply[1]),
                _ => {}
            }
        }
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"))
}

/// A picture of the screen.
#[derive(Clone, PartialEq)]
pub struct Picture(Vec<[u8; 3]>);

impl Picture {
    /// Writes it as PNG, to see what a test saw.
    pub fn save(&self, path: &Path) {
        let pixels: Vec<u8> = self.0.as_flattened().to_vec();
        let file = std::fs::File::create(path).expect("writable");
        let mut encoder = png::Encoder::new(file, u32::from(SIZE.0), u32::from(SIZE.1));
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().expect("writable");
        writer.write_image_data(&pixels).expect("writable");
    }

    /// Pixels (x, y) inside `area` (left, top, right, bottom) that differ by more than noise.
    pub fn difference(&self, other: &Self, area: (u16, u16, u16, u16)) -> Vec<(u16, u16)> {
        let (left, top, right, bottom) = area;
        let pixels = (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y)));
        pixels
            .filter(|&(x, y)| {
                let at = usize::from(y) * usize::from(SIZE.0) + usize::from(x);
                self.0[at].iter().zip(other.0[at]).any(|(a, b)| a.abs_diff(b) > 12)
            })
            .collect()
    }
}
