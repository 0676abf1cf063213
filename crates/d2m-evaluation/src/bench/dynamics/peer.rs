//! rapier3d-f64 on the same scenes: boxes as its own cuboids, which are its fastest shapes, all else as
//! triangles.
use super::scene::{Error, Expectation, Scene};
use crate::bench::peers::{pose, vector};
use d2m::bvh::TriMesh;
use d2m::motion::Pose;
use d2m_dynamics::{Body, BodyId, Joint, JointKind, Kind};
use glam::{DQuat, DVec3};
use rapier3d_f64::math::Matrix;
use rapier3d_f64::prelude::{
    ColliderBuilder, GenericJointBuilder, JointAxesMask, MassProperties, PhysicsWorld, RigidBodyBuilder,
    RigidBodyHandle,
};

/// This engine, and the version that is linked.
pub(super) const NAME: &str = "rapier";
pub(super) const VERSION: &str = rapier3d_f64::VERSION;

/// A scene in rapier.
pub(super) struct Peer {
    world: PhysicsWorld,
    handles: Vec<RigidBodyHandle>,
}

impl Peer {
    /// The scene as it starts. Pairs that ours ignores are of bodies that do not move freely, which never meet in
    /// rapier.
    pub(super) fn new(scene: &Scene) -> Result<Self, Error> {
        let (mut world, options) = (PhysicsWorld::new(), scene.simulation.options());
        world.integration_parameters.dt = options.step;
        world.gravity = vector(options.gravity);
        let mut handles = Vec::new();
        for ((body, id), start) in scene.bodies.iter().zip(scene.simulation.ids()).zip(scene.poses()) {
            let mut collider = collider(body.tree.mesh())?.friction(body.friction);
            if let Some(own) = scene.simulation.mass_properties(id) {
                let columns = own.inertia.to_cols_array();
                let (center, inertia) =
                    (vector(scene.simulation.center(id)), Matrix::from_cols_array(&columns));
                collider =
                    collider.mass_properties(MassProperties::with_inertia_matrix(center, own.mass, inertia));
            }
            let builder = rigid_body(body).pose(pose(start.rotation, start.translation));
            handles.push(world.insert(builder, collider).0);
        }
        let mut peer = Self { world, handles };
        for joint in &scene.joints {
            peer.join(joint, scene)?;
        }
        Ok(peer)
    }

    fn join(&mut self, joint: &Joint, scene: &Scene) -> Result<(), Error> {
        if joint.kind != JointKind::Revolute {
            return Err(format!("{:?} joints are not compared", joint.kind).into());
        }
        let pose = |id: BodyId| scene.simulation.pose(id);
        let (first, a) = (self.handles[joint.a.index()], pose(joint.a));
        let (second, b) = match joint.b {
            Some(id) => (self.handles[id.index()], pose(id)),
            None => (self.world.insert_body(RigidBodyBuilder::fixed()), Pose::IDENTITY),
        };
        let local = |of: Pose| {
            let back = of.rotation.conjugate();
            (vector(back * (joint.point - of.translation)), vector(back * joint.axis))
        };
        let ((anchor1, axis1), (anchor2, axis2)) = (local(a), local(b));
        let builder = GenericJointBuilder::new(JointAxesMask::LOCKED_REVOLUTE_AXES)
            .local_axis1(axis1)
            .local_axis2(axis2)
            .local_anchor1(anchor1)
            .local_anchor2(anchor2)
            .contacts_enabled(joint.collide);
        self.world.insert_impulse_joint(first, second, builder);
        Ok(())
    }

    pub(super) fn step(&mut self) {
        self.world.step();
    }

    /// Where the bodies are now.
    pub(super) fn poses(&self) -> Vec<Pose> {
        let of = |&handle: &RigidBodyHandle| {
            let at = self.world.bodies[handle].position();
            let (x, q) = (at.translation, at.rotation);
            Pose::new(DVec3::new(x.x, x.y, x.z), DQuat::from_xyzw(q.x, q.y, q.z, q.w))
        };
        self.handles.iter().map(of).collect()
    }

    /// What is wrong with the run; empty if nothing. That bodies intersect is counted, not judged.
    pub(super) fn fault(&self, scene: &Scene) -> String {
        let poses = self.poses();
        let lost = scene.ids.iter().filter(|id| poses[id.index()].translation.y < 0.0).count();
        match scene.expectation {
            Expectation::Above(_) if lost > 0 => format!("{lost} bodies fell through the floor"),
            _ => String::new(),
        }
    }
}

fn rigid_body(body: &Body) -> RigidBodyBuilder {
    match &body.kind {
        Kind::Kinematic(motion) => {
            let twist = motion.pose_and_twist(0.0).1;
            let builder = RigidBodyBuilder::kinematic_velocity_based();
            builder.linvel(vector(twist.linear)).angvel(vector(twist.angular))
        }
        Kind::Dynamic => RigidBodyBuilder::dynamic()
            .linvel(vector(body.linear_velocity))
            .angvel(vector(body.angular_velocity)),
        _ => RigidBodyBuilder::fixed(),
    }
}

/// A cuboid if the mesh is one about the origin.
fn collider(mesh: &TriMesh) -> Result<ColliderBuilder, Error> {
    let corner = mesh.vertices().iter().fold(DVec3::ZERO, |most, v| most.max(v.abs()));
    if mesh.vertices().len() == 8 && mesh.vertices().iter().all(|v| v.abs() == corner) {
        return Ok(ColliderBuilder::cuboid(corner.x, corner.y, corner.z));
    }
    let vertices = mesh.vertices().iter().map(|&v| vector(v)).collect();
    Ok(ColliderBuilder::trimesh(vertices, mesh.triangles().to_vec())?)
}
