//! One index per vertex: files that index positions, texture coordinates and normals apart are turned into meshes in
//! which a vertex has one of each. Equal triples share a vertex.

use std::collections::HashMap;

/// "This corner has none of it".
pub(crate) const NONE: u32 = u32::MAX;

/// A corner as a file gives it: indices of position, texture coordinates, normal ([`NONE`] where missing).
pub(crate) type Corner = [u32; 3];

/// The vertices made so far, in order of first use.
pub(crate) struct Welder {
    /// The corner that each vertex stands for.
    pub(crate) vertices: Vec<Corner>,
    /// For each position its first vertex; most positions have no other, and need no hashing.
    first: Vec<u32>,
    others: HashMap<Corner, u32>,
}

impl Welder {
    pub(crate) fn new() -> Self {
        Self { vertices: Vec::new(), first: Vec::new(), others: HashMap::new() }
    }

    /// The vertex of a corner, and whether it is new. The position index must be one that exists: memory grows with it.
    pub(crate) fn vertex(&mut self, corner: Corner) -> (u32, bool) {
        let next = self.vertices.len() as u32;
        let position = corner[0] as usize;
        if position >= self.first.len() {
            self.first.resize(position + 1, NONE);
        }
        let id = match self.first.get_mut(position) {
            Some(first) if *first == NONE => {
                *first = next;
                next
            }
            Some(first) if self.vertices.get(*first as usize) == Some(&corner) => *first,
            _ => *self.others.entry(corner).or_insert(next),
        };
        if id == next {
            self.vertices.push(corner);
        }
        (id, id == next)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_corners_share_a_vertex() {
        let mut welder = Welder::new();
        let corners = [[7, 0, 0], [2, 0, NONE], [7, 1, 0], [7, 0, 0], [7, 1, 0], [2, 0, NONE]];
        let ids = corners.map(|corner| welder.vertex(corner));
        assert_eq!(ids, [(0, true), (1, true), (2, true), (0, false), (2, false), (1, false)]);
        assert_eq!(welder.vertices, [[7, 0, 0], [2, 0, NONE], [7, 1, 0]]);
    }
}
