//! Small files of every format, all of them the same tetrahedron in place.
#![allow(dead_code)] // each test takes some

use d2m_bvh::TriMesh;
use d2m_io::MeshFormat;
use glam::DVec3;
use std::io::{Cursor, Write};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

pub(crate) fn tetrahedron() -> TriMesh {
    let vertices = [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0, 0.0, 0.3]];
    TriMesh::from_arrays(&vertices, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap()
}

pub(crate) const OFF: &str =
    "OFF # a comment\n4 4 6\n0 0 0\n0.1 0 0\n0 0.2 0\n0 0 0.3\n3 0 2 1\n3 0 1 3 255 0 0\n3 0 3 2\n3 1 2 3\n";

/// A scene of nodes around one geometry.
pub(crate) fn dae(nodes: &str) -> String {
    format!(
        r##"<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
 <asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
 <library_geometries>
  <geometry id="g"><mesh>
   <source id="p"><float_array id="pa" count="12">0 0 0 0.1 0 0 0 0.2 0 0 0 0.3</float_array>
    <technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
   <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
   <polylist count="2"><input semantic="NORMAL" source="#p" offset="1"/><input semantic="VERTEX" source="#v" offset="0"/>
    <vcount>3 3</vcount><p>0 9 2 9 1 9 0 9 1 9 3 9</p></polylist>
   <triangles count="2"><input semantic="VERTEX" source="#v" offset="0"/><p>0 3 2 1 2 3</p></triangles>
  </mesh></geometry>
 </library_geometries>
 <library_nodes><node id="sub"><translate>0 0 1</translate><instance_geometry url="#g"/></node></library_nodes>
 <library_visual_scenes><visual_scene id="s">{nodes}</visual_scene></library_visual_scenes>
 <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
"##
    )
}

pub(crate) const DAE_NODES: &str = r##"<node id="n"><instance_geometry url="#g"/></node>"##;

pub(crate) const MODEL: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<model unit="meter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
 <resources><object id="1" type="model"><mesh>
  <vertices><vertex x="0" y="0" z="0"/><vertex x="0.1" y="0" z="0"/><vertex x="0" y="0.2" z="0"/><vertex x="0" y="0" z="0.3"/></vertices>
  <triangles><triangle v1="0" v2="2" v3="1"/><triangle v1="0" v2="1" v3="3"/><triangle v1="0" v2="3" v3="2"/><triangle v1="1" v2="2" v3="3"/></triangles>
 </mesh></object></resources>
 <build><item objectid="1"/></build>
</model>
"#;

/// A zip archive of named texts.
pub(crate) fn archive(parts: &[(&str, &str)]) -> Vec<u8> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, text) in parts {
        writer.start_file(*name, SimpleFileOptions::default()).unwrap();
        writer.write_all(text.as_bytes()).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

pub(crate) fn three_mf(model: &str) -> Vec<u8> {
    let relations = r#"<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/a.model" Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>"#;
    archive(&[("_rels/.rels", relations), ("3D/a.model", model)])
}

/// The tetrahedron as glTF with its buffer in the text; `nodes` and what else is wanted besides.
pub(crate) fn gltf(nodes: &str) -> String {
    let mesh = tetrahedron();
    let positions =
        mesh.vertices().iter().flat_map(|p: &DVec3| p.to_array()).flat_map(|x| (x as f32).to_le_bytes());
    let indices = mesh.triangles().iter().flatten().map(|&index| index as u8);
    let bytes: Vec<u8> = positions.chain(indices).collect();
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{nodes}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":9}},"indices":1,"mode":4}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}},{{"bufferView":1,"componentType":5121,"count":12,"type":"SCALAR"}}],
"bufferViews":[{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":12}}],
"buffers":[{{"byteLength":60,"uri":"data:application/octet-stream;base64,{}"}}]}}"#,
        base64(&bytes)
    )
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    assert_eq!(bytes.len() % 3, 0);
    let four = |three: &[u8]| {
        let bits = u32::from(three[0]) << 16 | u32::from(three[1]) << 8 | u32::from(three[2]);
        [18, 12, 6, 0].map(|shift| DIGITS[(bits >> shift) as usize & 63] as char)
    };
    bytes.chunks(3).flat_map(four).collect()
}

/// A small file of each format.
pub(crate) fn all() -> Vec<(MeshFormat, Vec<u8>)> {
    let mesh = tetrahedron();
    vec![
        (MeshFormat::Obj, d2m_io::obj_text(&mesh).into_bytes()),
        (MeshFormat::Ply, d2m_io::ply_bytes(&mesh)),
        (MeshFormat::Off, OFF.as_bytes().to_vec()),
        (MeshFormat::Dae, dae(DAE_NODES).into_bytes()),
        (MeshFormat::ThreeMf, three_mf(MODEL)),
        (MeshFormat::Gltf, gltf(r#"{"mesh":0}"#).into_bytes()),
        (MeshFormat::Glb, d2m_io::glb_bytes(&mesh).unwrap()),
    ]
}
