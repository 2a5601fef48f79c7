#pragma once
#include "arithmetic/kernel_path.hpp"
#include "arithmetic/unfused_sets.hpp"
#include "tissue/shape_matching_kernel.hpp"

namespace vibe {
namespace {

template <class Arch>
struct Kernel {
  static constexpr int kLanes = 8;
  static constexpr int kNewtonSteps = 1;  // sufficient because the predicted orientation is close
  using Pack = xsimd::batch<double, Arch>;
  static constexpr int kWidth = static_cast<int>(Pack::size);

  struct Vec {
    Pack x, y, z;
  };
  struct Mat {
    Vec c0, c1, c2;  // columns
  };
  struct Quat {
    Pack w, x, y, z;
  };

  static Pack load(const double* p) { return Pack::load_unaligned(p); }

  static Pack gather(const double* base, const std::int32_t* index) {
    alignas(64) double buffer[kWidth];
    for (int lane = 0; lane < kWidth; ++lane) buffer[lane] = base[index[lane]];
    return Pack::load_aligned(buffer);
  }

  static Vec cross(const Vec& a, const Vec& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  static Pack dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  static Vec add(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  static Vec scaled(const Vec& a, const Pack& s) { return {a.x * s, a.y * s, a.z * s}; }

  static Mat rotation(const Quat& q) {
    const Pack one(1.0), two(2.0);
    const Pack xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
    const Pack xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
    const Pack wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
    return {{one - two * (yy + zz), two * (xy + wz), two * (xz - wy)},
            {two * (xy - wz), one - two * (xx + zz), two * (yz + wx)},
            {two * (xz + wy), two * (yz - wx), one - two * (xx + yy)}};
  }

  // q times the rotation (1, w/2), normalised: the Cayley map of w
  static Quat rotated(const Quat& q, const Vec& w) {
    const Pack half(0.5);
    const Vec h = scaled(w, half);
    Quat r{q.w - q.x * h.x - q.y * h.y - q.z * h.z, q.x + q.w * h.x + q.y * h.z - q.z * h.y,
           q.y + q.w * h.y + q.z * h.x - q.x * h.z, q.z + q.w * h.z + q.x * h.y - q.y * h.x};
    const Pack scale = Pack(1.0) / xsimd::sqrt(r.w * r.w + r.x * r.x + r.y * r.y + r.z * r.z);
    return {r.w * scale, r.x * scale, r.y * scale, r.z * scale};
  }

  // (0, h) q added to q, normalised: the rotation vector 2 h in world
  static Quat turned(const Quat& q, const Vec& h) {
    Quat r{q.w - h.x * q.x - h.y * q.y - h.z * q.z, q.x + h.x * q.w + h.y * q.z - h.z * q.y,
           q.y + h.y * q.w + h.z * q.x - h.x * q.z, q.z + h.z * q.w + h.x * q.y - h.y * q.x};
    const Pack scale = Pack(1.0) / xsimd::sqrt(r.w * r.w + r.x * r.x + r.y * r.y + r.z * r.z);
    return {r.w * scale, r.x * scale, r.y * scale, r.z * scale};
  }

  // scale times the vector part of new * conj(old), by the shorter way
  static Vec turnRate(const Quat& o, const Quat& n, const Pack& scale) {
    const Pack aligned = n.w * o.w + n.x * o.x + n.y * o.y + n.z * o.z;
    const Pack s = xsimd::select(aligned < Pack(0.0), -scale, scale);
    return {s * (n.x * o.w - n.w * o.x - n.y * o.z + n.z * o.y), s * (n.y * o.w - n.w * o.y - n.z * o.x + n.x * o.z),
            s * (n.z * o.w - n.w * o.z - n.x * o.y + n.y * o.x)};
  }

  static void store(const Quat& q, const Vec& w, const ClusterSweep& s, int cluster) {
    q.w.store_unaligned(s.qw + cluster);
    q.x.store_unaligned(s.qx + cluster);
    q.y.store_unaligned(s.qy + cluster);
    q.z.store_unaligned(s.qz + cluster);
    w.x.store_unaligned(s.wx + cluster);
    w.y.store_unaligned(s.wy + cluster);
    w.z.store_unaligned(s.wz + cluster);
  }

  // One Newton step of max over w of trace(exp(-[w]) R^T A). The Hessian tr(B) I - sym(B) is positive definite near the
  // maximum. Far from it (inverted or collapsed cluster) the step falls back to the gradient. A step never exceeds
  // about 50 degrees.
  static Quat newtonStep(const Quat& q, const Mat& a) {
    const Mat r = rotation(q);
    const Pack b00 = dot(r.c0, a.c0), b01 = dot(r.c0, a.c1), b02 = dot(r.c0, a.c2);
    const Pack b10 = dot(r.c1, a.c0), b11 = dot(r.c1, a.c1), b12 = dot(r.c1, a.c2);
    const Pack b20 = dot(r.c2, a.c0), b21 = dot(r.c2, a.c1), b22 = dot(r.c2, a.c2);
    const Vec g{b21 - b12, b02 - b20, b10 - b01};
    const Pack half(0.5), zero(0.0), tiny(1e-30);
    const Pack trace = b00 + b11 + b22;
    const Pack h00 = b11 + b22, h11 = b00 + b22, h22 = b00 + b11;
    const Pack h01 = -half * (b01 + b10), h02 = -half * (b02 + b20), h12 = -half * (b12 + b21);
    const Pack c00 = h11 * h22 - h12 * h12, c01 = h02 * h12 - h01 * h22, c02 = h01 * h12 - h02 * h11;
    const Pack c11 = h00 * h22 - h02 * h02, c12 = h01 * h02 - h00 * h12, c22 = h00 * h11 - h01 * h01;
    const Pack det = h00 * c00 + h01 * c01 + h02 * c02;
    const Pack size = xsimd::abs(trace) + tiny;
    const auto definite = (h00 > zero) & (c22 > zero) & (det > Pack(1e-6) * size * size * size);
    const Pack inverse = Pack(1.0) / xsimd::select(definite, det, Pack(1.0));
    const Pack gradient_scale = Pack(1.0) / size;
    Vec w{xsimd::select(definite, (c00 * g.x + c01 * g.y + c02 * g.z) * inverse, g.x * gradient_scale),
          xsimd::select(definite, (c01 * g.x + c11 * g.y + c12 * g.z) * inverse, g.y * gradient_scale),
          xsimd::select(definite, (c02 * g.x + c12 * g.y + c22 * g.z) * inverse, g.z * gradient_scale)};
    const Pack length2 = dot(w, w);
    const Pack limit =
        xsimd::select(length2 > Pack(1.0), Pack(1.0) / xsimd::sqrt(xsimd::max(length2, Pack(1.0))), Pack(1.0));
    return rotated(q, scaled(w, limit));
  }

  struct Moments {
    Vec centre_of_mass;  // relative to the centre particle
    Mat a;               // sum of weight * (x - centre) * rest^T
    Vec area;
    Pack square;  // sum of weight * |x - centre|^2
  };

  static Vec member(const ClusterSweep& s, int slot, const Vec& origin) {
    const std::int32_t* index = s.particle + slot;
    return {gather(s.x, index) - origin.x, gather(s.y, index) - origin.y, gather(s.z, index) - origin.z};
  }

  static Moments accumulate(const ClusterSweep& s, int first_slot, int rows, const Vec& origin) {
    const Pack zero(0.0);
    const Vec none{zero, zero, zero};
    Moments m{none, {none, none, none}, none, zero};
    Vec first = none, previous = none;
    for (int row = 1; row < rows; ++row) {
      const int slot = first_slot + row * kLanes;
      const Vec d = member(s, slot, origin);
      const Vec wd = scaled(d, load(s.weight + slot));
      m.centre_of_mass = add(m.centre_of_mass, wd);
      m.square = m.square + dot(wd, d);
      m.a.c0 = add(m.a.c0, scaled(wd, load(s.rest_x + slot)));
      m.a.c1 = add(m.a.c1, scaled(wd, load(s.rest_y + slot)));
      m.a.c2 = add(m.a.c2, scaled(wd, load(s.rest_z + slot)));
      if (row == 1)
        first = d;
      else
        m.area = add(m.area, cross(previous, d));
      previous = d;
    }
    m.area = scaled(add(m.area, cross(previous, first)), Pack(1.0 / 6.0));
    return m;
  }

  static void writeGoals(const ClusterSweep& s, int first_slot, int rows, const Vec& origin, const Moments& m,
                         const Mat& r, const Pack& gain) {
    for (int row = 0; row < rows; ++row) {
      const int slot = first_slot + row * kLanes;
      const Vec d = member(s, slot, origin);
      const Pack rx = load(s.rest_x + slot), ry = load(s.rest_y + slot), rz = load(s.rest_z + slot);
      const Vec goal = add(add(scaled(r.c0, rx), scaled(r.c1, ry)), add(scaled(r.c2, rz), m.centre_of_mass));
      (gain * (goal.x - d.x)).store_unaligned(s.dx + slot);
      (gain * (goal.y - d.y)).store_unaligned(s.dy + slot);
      (gain * (goal.z - d.z)).store_unaligned(s.dz + slot);
    }
  }

  static void sweepPack(const ClusterSweep& s, int group, int lane) {
    const int first_slot = s.row_offset[group] * kLanes + lane;
    const int rows = s.row_offset[group + 1] - s.row_offset[group];
    const int cluster = group * kLanes + lane;
    const std::int32_t* centre = s.particle + first_slot;
    const Vec origin{gather(s.x, centre), gather(s.y, centre), gather(s.z, centre)};
    Moments m = accumulate(s, first_slot, rows, origin);

    const Quat old{load(s.qw + cluster), load(s.qx + cluster), load(s.qy + cluster), load(s.qz + cluster)};
    const Vec spin{load(s.wx + cluster), load(s.wy + cluster), load(s.wz + cluster)};
    Quat q = turned(old, scaled(spin, Pack(0.5 * s.substep)));
    const Pack own = load(s.orientation_weight + cluster);
    const Mat predicted = rotation(q);
    const Mat a{add(m.a.c0, scaled(predicted.c0, own)), add(m.a.c1, scaled(predicted.c1, own)),
                add(m.a.c2, scaled(predicted.c2, own))};
    for (int i = 0; i < kNewtonSteps; ++i) q = newtonStep(q, a);

    writeGoals(s, first_slot, rows, origin, m, rotation(q), load(s.gain + cluster));
    store(q, turnRate(old, q, Pack(s.substep > 0 ? 2 / s.substep : 0)), s, cluster);
    m.area.x.store_unaligned(s.area_x + cluster);
    m.area.y.store_unaligned(s.area_y + cluster);
    m.area.z.store_unaligned(s.area_z + cluster);
    (m.square - dot(m.centre_of_mass, m.centre_of_mass)).store_unaligned(s.spread + cluster);
  }

  static void sweep(const ClusterSweep& s, int first_group, int last_group) {
    for (int group = first_group; group < last_group; ++group)
      for (int lane = 0; lane < kLanes; lane += kWidth) sweepPack(s, group, lane);
  }
};

}  // namespace

void VIBE_KERNEL(sweepClusters)(const ClusterSweep& sweep, int first_group, int last_group) {
  Kernel<UnfusedSets::VIBE_KERNEL_SET>::sweep(sweep, first_group, last_group);
}

}  // namespace vibe
