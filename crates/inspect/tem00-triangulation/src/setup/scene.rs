use super::Setup;
use crate::file::{light_keys, relief_keys};

impl Setup {
    /// Returns the set-up as a scene file with a flat plate at a height, in metres, to be rendered.
    ///
    /// The laser stands straight above the line, as far from it as the camera; its line is of uniform
    /// power along it and has its waist on the reference plane.
    pub fn scene(&self, height: f64) -> String {
        let d = self.description();
        let (laser, camera) = (&d.laser, &d.camera);
        let fan_angle = 2.0 * libm::atan(0.5 * laser.line_length / camera.distance);
        let position = self.camera().position();
        let plate = 2.0 * laser.line_length.max(self.field_width());
        let [width, rows] = camera.resolution;
        format!(
            "[camera]\n\
             position = [{x:e}, {y:e}, {z:e}]\nlook_at = [0, 0, 0]\nup = [0, 0, 1]\n\
             focal_length = {focal_length:e}\nf_number = {f_number:e}\npixel_pitch = {pitch:e}\n\
             resolution = [{width}, {rows}]\ntilt = {{ angle = {tilt:e} }}\n{principal}\n\
             [[laser]]\n\
             {light}power = {power:e}\nposition = [0, {beside:e}, {distance:e}]\n\
             look_at = [0, {offset:e}, 0]\nline_direction = [1, 0, 0]\n\
             [laser.line]\n\
             fan_angle = {fan_angle:e}\nthickness = {line_thickness:e}\nprofile = \"uniform\"\n\n\
             [[surface]]\nname = \"plate\"\n{relief}\
             [surface.rectangle]\n\
             centre = [0, 0, {height:e}]\nnormal = [0, 0, 1]\nsize = [{plate:e}, {plate:e}]\n\
             [surface.lambertian]\nreflectance = {reflectance:e}\n",
            x = position.x,
            y = position.y,
            z = position.z,
            focal_length = camera.focal_length,
            f_number = camera.f_number,
            pitch = d.effective_pixel_pitch(),
            tilt = self.camera().description().tilt.angle,
            principal = camera.principal_row.map_or_else(String::new, |row| {
                let middle = 0.5 * width as f64;
                format!("principal_point = [{middle:e}, {row:e}]\n")
            }),
            light = light_keys(&laser.light),
            relief = relief_keys(d.surface.relief),
            power = laser.power,
            beside = d.laser_point_at(camera.distance).y,
            offset = d.laser_offset(),
            distance = camera.distance,
            line_thickness = laser.line_thickness,
            reflectance = d.surface.reflectance,
        )
    }
}
