//! What a body is drawn as.

use anyhow::Result;

use super::{Body, FrustumBase, Mesh, MeshSource};
use crate::files::choices;

choices! {
    /// The model of a body that candidates are drawn with (METHOD A4).
    #[derive(Default)]
    "model" pub enum Model => pub frusta: Option<FrustumBase> {
        /// Truncated cones as flat quadrilaterals with one depth each (the default).
        "flat" #[default] Flat => None,
        /// The mesh that the body's `[mesh]` names, or elliptic frusta of 66 vertices; with a depth a pixel.
        "mesh" Mesh => None,
        /// Frusta over a square, 8 vertices a part, whatever mesh the body's file names.
        "square" Square => Some(FrustumBase::Square),
        /// Elliptic frusta of 18 vertices a part, whatever mesh the body's file names.
        "elliptic-18" Elliptic18 => Some(FrustumBase::Elliptic { vertices: 18 }),
        /// The same with 34 vertices.
        "elliptic-34" Elliptic34 => Some(FrustumBase::Elliptic { vertices: 34 }),
        /// The same with 66 vertices.
        "elliptic-66" Elliptic66 => Some(FrustumBase::Elliptic { vertices: 66 }),
        /// The same with 130 vertices.
        "elliptic-130" Elliptic130 => Some(FrustumBase::Elliptic { vertices: 130 }),
        /// The same with 258 vertices.
        "elliptic-258" Elliptic258 => Some(FrustumBase::Elliptic { vertices: 258 }),
        /// The same with 514 vertices.
        "elliptic-514" Elliptic514 => Some(FrustumBase::Elliptic { vertices: 514 }),
    }
}

impl Model {
    /// The flat model and the rungs of the ladder of frusta.
    pub fn ladder() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|model| *model != Self::Mesh)
    }

    /// The mesh that a body is drawn as; none for the flat model.
    ///
    /// # Errors
    /// As [`Mesh::of_body`].
    pub fn mesh(self, body: &Body) -> Result<Option<Mesh>> {
        match self.dressed(body) {
            Some(dressed) => Mesh::of_body(&dressed).map(Some),
            None if self == Self::Flat => Ok(None),
            None => Mesh::of_body(body).map(Some),
        }
    }

    /// The body to be drawn so, where that is not the body as it is: with frusta, as flat as its file has them.
    pub fn dressed(self, body: &Body) -> Option<Body> {
        let base = self.frusta()?;
        let flattening = match &body.mesh {
            Some(MeshSource::Frusta { flattening, .. }) => flattening.clone(),
            _ => Default::default(),
        };
        Some(Body { mesh: Some(MeshSource::Frusta { base, flattening }), ..body.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rung_has_a_name_and_is_drawn() {
        let rungs: Vec<FrustumBase> = Model::ladder().filter_map(|model| model.frusta()).collect();
        let elliptic = FrustumBase::LADDER.map(|vertices| FrustumBase::Elliptic { vertices });
        assert_eq!(rungs, [vec![FrustumBase::Square], elliptic.to_vec()].concat());
        let body = Body::adult(1750.0).unwrap();
        for model in Model::ladder().skip(1) {
            let base = model.frusta().unwrap();
            let expected = match base {
                FrustumBase::Square => "square".to_string(),
                FrustumBase::Elliptic { vertices } => format!("elliptic-{vertices}"),
            };
            assert_eq!(model.name(), expected);
            let mesh = model.mesh(&body).unwrap().unwrap();
            assert_eq!(mesh.vertices.len(), base.vertices() as usize * body.parts.len(), "{model}");
        }
        assert!(Model::Flat.mesh(&body).unwrap().is_none());
        assert_eq!(Model::Mesh.mesh(&body).unwrap(), Model::Elliptic66.mesh(&body).unwrap());
    }
}
