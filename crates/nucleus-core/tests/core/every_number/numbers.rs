//! The numbers of the input of a frame, found by visitors that name every field.

use nucleus_core::{
    Bending, Birth, ClothFrame, ColliderFrame, ConstraintFrame, Falloff, Field, FieldKind, Fold, ForceField,
    FrameInput, GroundPlane, InputAttract, InputMesh, Link, LinkForce, LinkKind, LinkSide, Liquid, Noise,
    ParticleChange, Pin, PointField, Pressure, PushOut, Reach, ResistanceModel, SelfCollision, StartVelocity,
    Stiffness, Volume, VolumeAxis, WindField,
};

/// The numbers of an input, by name.
#[derive(Default)]
pub struct Numbers<'a>(pub Vec<(String, &'a mut f64)>);

impl<'a> Numbers<'a> {
    fn add(&mut self, name: &str, numbers: impl IntoIterator<Item = &'a mut f64>) {
        self.0.extend(numbers.into_iter().map(|number| (name.to_owned(), number)));
    }

    pub fn frame(&mut self, frame: &'a mut FrameInput) {
        let FrameInput {
            duration,
            substeps: _,
            collision_iterations,
            resistance,
            gravity,
            wind,
            air_density,
            plane,
            cloths,
            colliders,
            layer_range,
            self_collision_iterations,
            pins,
            velocities,
            wind_noise,
            input_meshes,
            constraints,
            exclusions: _,
            births,
            particle_changes,
            fields,
            fields_per_substep: _,
        } = frame;
        self.add("duration", [duration]);
        self.add("iterations", [collision_iterations, self_collision_iterations]);
        if let ResistanceModel::Physical { evaluations } = resistance {
            self.add("evaluations", [evaluations]);
        }
        self.add("wind and gravity", [&mut gravity.y, &mut wind.x, air_density, wind_noise]);
        self.add("layer range", [layer_range]);
        let GroundPlane { origin, normal, start, bounce, friction, stickiness } =
            plane.as_mut().expect("a plane");
        let [from, _] = start.get_or_insert([*origin, *normal]);
        self.add("plane", [&mut origin.y, &mut normal.x, &mut from.y, bounce, friction, stickiness]);
        cloths.iter_mut().for_each(|cloth| self.cloth(cloth));
        colliders.iter_mut().for_each(|collider| self.collider(collider));
        for Pin { cloth: _, point: _, start, end } in pins {
            self.add("pin", [&mut start.x, &mut end.z]);
        }
        for StartVelocity { cloth: _, point: _, velocity, acceleration } in velocities {
            self.add("start velocity", [&mut velocity.y, &mut acceleration.x]);
        }
        for InputMesh { cloth: _, start, end } in input_meshes {
            self.add("input mesh", [&mut start[1].x, &mut end[2].y]);
        }
        constraints.iter_mut().for_each(|constraint| self.constraint(constraint));
        for Birth { cloth: _, time, position, velocity, lifespan } in births {
            self.add("birth", [time, &mut position.x, &mut velocity.z]);
            self.add("lifespan of a birth", [lifespan]);
        }
        for ParticleChange { cloth: _, place: _, velocity, lifespan } in particle_changes {
            self.add("velocity of a change", velocity.iter_mut().flatten());
            self.add("lifespan of a change", lifespan);
        }
        fields.iter_mut().for_each(|field| self.field(field));
    }

    fn cloth(&mut self, cloth: &'a mut ClothFrame) {
        let ClothFrame {
            stretch_resistance,
            compression_resistance,
            shear_resistance,
            bend_resistance,
            stiffness,
            buckles: _,
            rest_length_scale,
            tethers,
            stretch_damp,
            damp,
            drag,
            tangential_drag,
            lift,
            feels_gravity: _,
            feels_wind: _,
            local_force,
            local_wind,
            collide: _,
            is_driven: _,
            thickness,
            friction,
            stickiness,
            bounce,
            collide_strength,
            push_out,
            crossover_push,
            self_crossover_push,
            elements: _,
            layer,
            self_collision,
            bending,
            yield_strain,
            pressure,
            rigidity,
            deform_resistance,
            input_attract,
            field,
            point_field,
            wind_field,
            liquid,
            conserve,
            rotation_friction,
            rotation_damp,
            overlap_pruning,
        } = cloth;
        self.add(
            "resistance",
            [stretch_resistance, compression_resistance, shear_resistance, bend_resistance],
        );
        let Stiffness { stretch, compression, shear, bend, warp, weft } = stiffness;
        self.add("stiffness", [stretch, compression, shear, bend, warp, weft].into_iter().flatten());
        self.add("scale", [rest_length_scale]);
        self.add("tethers", tethers);
        self.add("damping", [stretch_damp, damp, rigidity, deform_resistance]);
        self.add("air", [drag, tangential_drag, lift]);
        self.add("local force", [&mut local_force.x, &mut local_wind.y]);
        self.add("contact", [thickness, friction, stickiness, bounce, collide_strength, layer]);
        self.add("crossover", [crossover_push, self_crossover_push]);
        let SelfCollision { on: _, thickness, elements: _, edges: _ } = self_collision;
        self.add("self-collision", [thickness]);
        let Bending { angle_scale, angle_dropoff, solver: _, yield_sine, yield_half_angle } = bending;
        self.add("bending", [angle_scale, angle_dropoff]);
        self.add("yield limit", [yield_sine, yield_half_angle, yield_strain]);
        match pressure {
            Pressure::Off => {}
            Pressure::Manual { pascals, damping } => self.add("pressure", [pascals, damping]),
            Pressure::Gas { start, bulk, pump, tightness, damping, sealed: _ } => {
                self.add("gas", [start, bulk, pump, tightness, damping]);
            }
        }
        let InputAttract { strength, damp, motion_drag } = input_attract;
        self.add("input attract", [strength, damp, motion_drag]);
        if let Some(Liquid { spacing, incompressibility, viscosity, surface_tension }) = liquid {
            self.add("liquid", [spacing, incompressibility, viscosity, surface_tension]);
        }
        self.add("particles", [conserve, rotation_friction, rotation_damp, overlap_pruning]);
        self.surface(push_out, field, point_field, wind_field);
    }

    fn surface(
        &mut self,
        push_out: &'a mut PushOut,
        field: &'a mut Option<ForceField>,
        point_field: &'a mut Option<PointField>,
        wind_field: &'a mut WindField,
    ) {
        let PushOut { share, radius } = push_out;
        self.add("push out", [share, radius]);
        if let Some(ForceField { side: _, magnitude, distance, falloff }) = field {
            self.add("force field", [magnitude, distance]);
            self.add("falloff of a force field", &mut falloff[..2]);
        }
        if let Some(PointField { magnitude, self_attract, radius, distance, falloff }) = point_field {
            self.add("point field", [magnitude, self_attract, radius, distance]);
            self.add("falloff of a point field", &mut falloff[..2]);
        }
        let WindField { shadow_distance, shadow_diffusion, self_shadow: _, push_distance, push_vorticity } =
            wind_field;
        self.add("wind field", [shadow_distance, shadow_diffusion, push_distance, push_vorticity]);
    }

    fn collider(&mut self, collider: &'a mut ColliderFrame) {
        let ColliderFrame {
            start,
            end,
            collide: _,
            elements: _,
            layer,
            thickness,
            friction,
            stickiness,
            bounce,
            collide_strength,
            push_out,
            trapped_check: _,
            field,
            point_field,
            wind_field,
        } = collider;
        self.add("collider's motion", [&mut start[3].x, &mut end[4].y]);
        self.add("collider", [layer, thickness, friction, stickiness, bounce, collide_strength]);
        self.surface(push_out, field, point_field, wind_field);
    }

    fn constraint(&mut self, constraint: &'a mut ConstraintFrame) {
        let ConstraintFrame {
            formed,
            method: _,
            strength,
            tangent_strength,
            rest_scale,
            bend_strength,
            break_half_sine,
            iterations,
            glue_strength,
            glue_scale,
            can_break: _,
            slides: _,
            friction,
            keep_off,
            single_sided: _,
            damp,
            motion_drag,
            force,
            dropoff,
            space: [(linear, offset), _],
        } = constraint;
        self.add("strength of a constraint", [strength, tangent_strength, bend_strength]);
        self.add("rest scale", rest_scale);
        self.add("iterations of a constraint", iterations);
        self.add("glue of a constraint", [break_half_sine, glue_strength, glue_scale]);
        self.add("friction of a constraint", [friction, damp, motion_drag]);
        self.add("keep off", keep_off);
        if let Some(LinkForce { acceleration, falloff: Falloff { distance, samples } }) = force {
            self.add("force of a link", [acceleration, distance]);
            self.add("falloff of a link's force", &mut samples[..2]);
        }
        if let Some(Falloff { distance, samples }) = dropoff {
            self.add("dropoff", [distance]);
            self.add("samples of a dropoff", &mut samples[..2]);
        }
        self.add("space", [&mut linear.as_mut_slice()[1], &mut offset.z]);
        formed.iter_mut().flatten().for_each(|link| self.link(link));
    }

    fn link(&mut self, link: &'a mut Link) {
        let Link { sides, kind, rest, strength, tangent_strength, glue, weight, length } = link;
        self.add("length of a link", [rest, length]);
        self.add("strength of a link", [strength, tangent_strength, glue]);
        self.add("weight of a link", weight);
        match kind {
            LinkKind::Distance | LinkKind::Surface => {}
            LinkKind::Oblique(direction) => self.add("direction of a link", direction),
            LinkKind::Fold(Fold { max_length, holds: _ }) => self.add("fold", [max_length]),
        }
        for side in sides {
            match side {
                LinkSide::Cloth { cloth: _, points: _, weights } => self.add("weight on a cloth", weights),
                LinkSide::Collider { collider: _, points: _, weights } => {
                    self.add("weight on a collider", weights);
                }
                LinkSide::Space(place) => self.add("place in space", [&mut place.x]),
            }
        }
    }

    fn field(&mut self, field: &'a mut Field) {
        let Field { kind, reach, targets } = field;
        self.add("target of a field", targets.iter_mut().map(|(_, share)| share));
        let Reach { center, unit, attenuation, max_distance, falloff, volume, falls_off_in_volume: _ } =
            reach;
        self.add("reach", [&mut center.x, unit, attenuation]);
        self.add("largest distance", [max_distance]);
        self.add("falloff of a field", &mut falloff[..2]);
        if let Some(Volume { shape: _, to_local, offset, section, sweep, is_excluded: _ }) = volume {
            self.add("volume", [&mut to_local.as_mut_slice()[4], &mut offset.y, section]);
            self.add("sweep", sweep.iter_mut().flatten());
        }
        match kind {
            FieldKind::Gravity { acceleration: vector } | FieldKind::Uniform { force: vector } => {
                self.add("uniform field", [&mut vector.x]);
            }
            FieldKind::Radial { force } => self.add("radial field", [force]),
            FieldKind::Newton { magnitude, min_distance } => self.add("newton", [magnitude, min_distance]),
            FieldKind::Drag { magnitude, along, velocity, half_speed } => {
                self.add("drag field", [magnitude, &mut velocity.x, half_speed]);
                self.add("direction of drag", along.iter_mut().flatten());
            }
            FieldKind::Air { velocity, rate, component_only: _, spread } => {
                self.add("air field", [&mut velocity.x, rate]);
                self.add("spread", spread);
            }
            FieldKind::Turbulence { force, noise } => {
                self.add("turbulence", [force]);
                self.noise(noise);
            }
            FieldKind::Vortex { force, axis } => self.add("vortex", [force, &mut axis.x]),
            FieldKind::VolumeAxis(volume_axis) => self.volume_axis(volume_axis),
        }
    }

    fn volume_axis(&mut self, volume_axis: &'a mut VolumeAxis) {
        let VolumeAxis {
            from_center,
            from_axis,
            along_axis,
            around_axis,
            directional,
            axis,
            turbulence,
            noise,
        } = volume_axis;
        self.add("volume axis", [from_center, from_axis, along_axis, around_axis]);
        self.add("axis", [&mut directional.x, &mut axis.x, turbulence]);
        self.noise(noise);
    }

    fn noise(&mut self, noise: &'a mut Noise) {
        let Noise { frequency, phase, octaves: _, ratio } = noise;
        self.add("noise", [&mut frequency.x, &mut phase.y, ratio]);
    }
}
