"""From the film to camera rays, and back."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import drjit as dr
import mitsuba as mi

if TYPE_CHECKING:
    from collections.abc import Iterator

# The most samples that Dr.Jit records at a time.
_LARGEST_WAVEFRONT = 2**32 - 1


class CameraRays(NamedTuple):
    """Rays, where on the film they arrive (in pixels), what they weigh and where they count."""

    ray: mi.RayDifferential3f
    film: mi.Point2f
    weight: mi.Spectrum
    pixel: mi.Point2f


class Exposure:
    """A film that is exposed through a sensor, in as many passes as its samples need."""

    def __init__(self, sensor: mi.Sensor, seed: int, spp: int) -> None:
        self._sensor, self._film = sensor, sensor.film()
        self.sampler = sensor.sampler().clone()
        if spp:
            self.sampler.set_sample_count(spp)
        samples = self.sampler.sample_count()
        self._border = self._film.rfilter().border_size() if self._film.sample_border() else 0
        self._size = mi.ScalarVector2u(self._film.crop_size() + 2 * self._border)
        self._per_pass = self._samples_per_pass(samples)
        self._passes = samples // self._per_pass
        self.sampler.set_samples_per_wavefront(self._per_pass)
        self.sampler.seed(seed, self._wavefront())
        self._film.prepare([])
        self._block = self._film.create_block()
        self._block.set_coalesce(self._block.coalesce() and self._per_pass >= 4)

    def passes(self) -> Iterator[CameraRays]:
        """Yield the camera rays of each pass; what they find is added before the next."""
        for number in range(self._passes):
            if number > 0:
                self.sampler.advance()
                self.sampler.schedule_state()
                dr.eval(self._block.tensor())
            yield self._rays()

    def add(self, rays: CameraRays, radiance: mi.Spectrum, hit: mi.Bool) -> None:
        """Add what rays have found."""
        alpha = dr.select(hit, mi.Float(1.0), 0.0)
        value = mi.UnpolarizedSpectrum(rays.weight * radiance)
        if mi.has_flag(self._film.flags(), mi.FilmFlags.Special):
            channels = self._film.prepare_sample(
                value, rays.ray.wavelengths, self._block.channel_count(), alpha=alpha
            )
            self._block.put(rays.pixel, channels)
            return
        self._block.put(rays.pixel, rays.ray.wavelengths, value, alpha)

    def finish(self, develop: bool, evaluate: bool) -> mi.TensorXf:
        """Return the image, or nothing but the exposed film."""
        self._film.put_block(self._block)
        image = self._film.develop() if develop else mi.TensorXf()
        if not develop:
            self._film.schedule_storage()
        if evaluate:
            dr.eval(image)
            dr.sync_thread()
        return image

    def _wavefront(self) -> int:
        return int(self._size.x) * int(self._size.y) * self._per_pass

    def _samples_per_pass(self, samples: int) -> int:
        """Return the largest divisor of the samples per pixel with which a pass can be recorded."""
        area = int(self._size.x) * int(self._size.y)
        for passes in range(1, samples + 1):
            if samples % passes == 0 and samples // passes * area <= _LARGEST_WAVEFRONT:
                return samples // passes
        raise RuntimeError(f"an image of {area} pixels is larger than Dr.Jit can record")

    def _rays(self) -> CameraRays:
        corner = self._corner()
        film = mi.Point2f(corner) + self.sampler.next_2d()
        crop_size = mi.ScalarVector2f(self._film.crop_size())
        crop_offset = mi.ScalarVector2f(self._film.crop_offset())
        lens = self.sampler.next_2d() if self._sensor.needs_aperture_sample() else 0.0
        time = self._sensor.shutter_open()
        if self._sensor.shutter_open_time() > 0.0:
            time += self.sampler.next_1d() * self._sensor.shutter_open_time()
        ray, weight = self._sensor.sample_ray_differential(
            time, 0.0, (film - crop_offset) / crop_size, mi.Point2f(lens)
        )
        ray.scale_differential(dr.rsqrt(self.sampler.sample_count()))
        # A box counts all samples of a pixel alike; at its edges rounding would choose another.
        pixel = mi.Point2f(corner) + 0.5 if self._film.rfilter().is_box_filter() else film
        return CameraRays(ray, film, weight, pixel)

    def _corner(self) -> mi.Vector2i:
        """Return the corners of the pixels in turn, each as often as it has samples."""
        index = dr.arange(mi.UInt32, self._wavefront())
        shift = self._per_pass.bit_length() - 1
        if self._per_pass == 1 << shift:
            index >>= dr.opaque(mi.UInt32, shift)
        else:
            index //= dr.opaque(mi.UInt32, self._per_pass)
        row = index // int(self._size.x)
        column = index - row * int(self._size.x)
        corner = mi.Vector2i(mi.Int32(column), mi.Int32(row)) - self._border
        return corner + mi.Vector2i(self._film.crop_offset())
