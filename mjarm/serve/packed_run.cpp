#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "mjarm/serve/byte_order_internal.hpp"
#include "mjarm/serve/packed_run_internal.hpp"

namespace mjarm::serve {
namespace {

constexpr double kLengthUnit = 1e-5;           // [m] finer is not to be seen
constexpr double kQuatUnit = 1.0 / 32767;      // 0.004 degrees
constexpr double kMeshUnits = 65535;           // along the longest side of a mesh
constexpr double kStill = 1e-6;                // [m], and for parts of quaternions
constexpr std::int64_t kFarthest = 1LL << 40;  // [units] of what has flown away

/// A row of whole numbers, each as the difference to the one before.
class Deltas {
 public:
  explicit Deltas(std::string& out) : out_(out) {}
  void add(std::int64_t value) {
    const std::int64_t delta = value - last_;
    last_ = value;
    auto rest = (static_cast<std::uint64_t>(delta) << 1U) ^ static_cast<std::uint64_t>(delta >> 63);
    for (; rest > 0x7F; rest >>= 7U) out_ += static_cast<char>((rest & 0x7FU) | 0x80U);
    out_ += static_cast<char>(rest);
  }
  void add(double value, double unit) {
    const double units = std::isfinite(value) ? std::round(value / unit) : 0;
    const auto most = static_cast<double>(kFarthest);
    add(static_cast<std::int64_t>(std::clamp(units, -most, most)));
  }

 private:
  std::string& out_;
  std::int64_t last_ = 0;
};

void append_mesh(std::string& out, const DrawnMesh& mesh) {
  float lower[3] = {0, 0, 0};
  float upper[3] = {0, 0, 0};
  for (std::size_t i = 0; i < mesh.xyz.size(); ++i) {
    lower[i % 3] = i < 3 ? mesh.xyz[i] : std::min(lower[i % 3], mesh.xyz[i]);
    upper[i % 3] = i < 3 ? mesh.xyz[i] : std::max(upper[i % 3], mesh.xyz[i]);
  }
  const float longest =
      std::max({upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2], 1e-6F});
  const double unit = static_cast<double>(longest) / kMeshUnits;
  append_f64(out, unit);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Deltas row(out);
    for (std::size_t i = axis; i < mesh.xyz.size(); i += 3) {
      row.add(static_cast<double>(mesh.xyz[i]), unit);
    }
  }
  Deltas corners(out);
  for (const std::uint32_t corner : mesh.corners) corners.add(std::int64_t{corner});
}

void append_body(std::string& out, const BodyRecord& record, int body) {
  const auto b = static_cast<std::size_t>(body);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Deltas row(out);
    for (std::size_t i = 0; i < record.size(); ++i) {
      row.add(record.p_W(i)[3 * b + axis], kLengthUnit);
    }
  }
  // q and -q are the same rotation: of both the one nearer to the moment before.
  std::vector<double> sign(record.size(), 1.0);
  for (std::size_t i = 1; i < record.size(); ++i) {
    const auto now = record.quat(i).subspan(4 * b, 4);
    const auto before = record.quat(i - 1).subspan(4 * b, 4);
    double dot = 0;
    for (std::size_t k = 0; k < 4; ++k) dot += now[k] * before[k];
    sign[i] = dot < 0 ? -sign[i - 1] : sign[i - 1];
  }
  for (std::size_t part = 0; part < 4; ++part) {
    Deltas row(out);
    for (std::size_t i = 0; i < record.size(); ++i) {
      row.add(sign[i] * record.quat(i)[4 * b + part], kQuatUnit);
    }
  }
}

}  // namespace

std::vector<int> moving_bodies(const BodyRecord& record) {
  const auto same = [](std::span<const double> a, std::span<const double> b) {
    return std::ranges::equal(a, b, [](double x, double y) { return std::abs(x - y) < kStill; });
  };
  std::vector<int> out;
  for (int body = 1; body < record.bodies(); ++body) {
    const auto b = static_cast<std::size_t>(body);
    bool moves = false;
    for (std::size_t i = 1; i < record.size() && !moves; ++i) {
      moves = !same(record.p_W(i).subspan(3 * b, 3), record.p_W(0).subspan(3 * b, 3)) ||
              !same(record.quat(i).subspan(4 * b, 4), record.quat(0).subspan(4 * b, 4));
    }
    if (moves) out.push_back(body);
  }
  return out;
}

std::string deflated(const std::string& content) {
  uLongf size = compressBound(static_cast<uLong>(content.size()));
  std::string out(size, '\0');
  // Fails where there is no memory alone.
  const int code = compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                             reinterpret_cast<const Bytef*>(content.data()),
                             static_cast<uLong>(content.size()), Z_BEST_COMPRESSION);
  out.resize(code == Z_OK ? size : 0);
  return out;
}

std::string packed_run(std::span<const DrawnMesh> meshes, const BodyRecord& record,
                       std::span<const int> bodies) {
  std::string out;
  for (const DrawnMesh& mesh : meshes) append_mesh(out, mesh);
  for (std::size_t i = 0; i < record.size(); ++i) append_f64(out, record.time(i));
  const std::size_t nq = record.empty() ? 0 : record.qpos(0).size();
  for (std::size_t j = 0; j < nq; ++j) {
    for (std::size_t i = 0; i < record.size(); ++i) append_f64(out, record.qpos(i)[j]);
  }
  for (const int body : bodies) append_body(out, record, body);
  return deflated(out);
}

}  // namespace mjarm::serve
