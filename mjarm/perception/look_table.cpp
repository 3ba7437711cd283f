#include "mjarm/perception/look_table.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "mjarm/core/rotation.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::perception::look_table {
namespace {

constexpr std::array<const char*, kBodies> kNames{"box", "can", "step", "stranger", "twin"};

}  // namespace

Pose eye_at(const Eigen::Vector3d& target_W, double distance, double azimuth, double elevation) {
  const Eigen::Vector3d back(std::cos(elevation) * std::cos(azimuth),
                             std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  const Eigen::Vector3d x(-std::sin(azimuth), std::cos(azimuth), 0);
  Pose X_WC{.p = target_W + distance * back};
  X_WC.R << x, x.cross(back), -back;
  return X_WC;
}

Pose standing(double x, double y, double z, double yaw) {
  return {.p = {x, y, z}, .R = from_euler({0, 0, yaw})};
}

Places random_places(Rng& rng, Body alone) {
  const auto yaw = [&] { return rng.uniform(-std::numbers::pi, std::numbers::pi); };
  const auto near = [&](double x) { return x + rng.uniform(-0.02, 0.02); };
  const Pose on_side{.R = from_euler({std::numbers::pi / 2, 0, 0})};
  const double elevation = rng.uniform(0.6, 1.48);
  const bool low = elevation < 1;
  Places out{.eye = eye_at({0, 0, 0.03}, rng.uniform(low ? 0.4 : 0.5, 0.8), yaw(), elevation)};
  out.bodies[kBox] = standing(near(-0.08), near(0), 0.03, yaw());
  const bool can_lies = rng.below(3) == 0;
  out.bodies[kCan] = standing(near(0.06), near(0.07), can_lies ? 0.033 : 0.05, yaw());
  if (can_lies) *out.bodies[kCan] = *out.bodies[kCan] * on_side;
  const bool step_lies = rng.below(3) == 0;
  out.bodies[kStep] = standing(near(0.07), near(-0.07), step_lies ? 0.025 : 0, yaw());
  if (step_lies) *out.bodies[kStep] = *out.bodies[kStep] * on_side;
  for (std::size_t k = 0; low && k < kStranger; ++k) {
    if (k != alone) out.bodies[k].reset();
  }
  return out;
}

struct Table::Impl {
  Sim sim;
  render::RgbdCamera camera;
};

Table::Table(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Table::~Table() = default;
Table::Table(Table&&) noexcept = default;
Table& Table::operator=(Table&&) noexcept = default;

Result<Table> Table::open(const render::RgbdOptions& options) {
  const auto file = find_model_file("scenes/look_table.xml");
  if (!file) return fail(file.error());
  Result<Model> model = Model::load(*file);
  if (!model) return fail(std::move(model.error()));
  Result<render::RgbdCamera> camera = render::RgbdCamera::create(*model, "eye", options);
  if (!camera) return fail(std::move(camera.error()));
  return Table(std::make_unique<Impl>(Impl{Sim(*model), std::move(*camera)}));
}

const Model& Table::model() const { return impl_->sim.model(); }

Result<render::RgbdFrame> Table::look(const Places& places, Rng& noise) {
  // A camera of MuJoCo looks along -z, with y upwards.
  const Pose flip{.R = Eigen::Vector3d(1, -1, -1).asDiagonal()};
  impl_->sim.place_free("eye", places.eye * flip);
  for (std::size_t i = 0; i < kBodies; ++i) {
    const Pose hidden{.p = {5 + static_cast<double>(i), 5, 0}};
    impl_->sim.place_free(kNames[i], places.bodies[i].value_or(hidden));
  }
  return impl_->camera.look(impl_->sim.snapshot(), noise);
}

Result<std::vector<KnownObject>> objects(const Model& model, bool with_tag) {
  std::vector<KnownObject> out;
  for (const std::size_t k : {kBox, kCan, kStep}) {
    Result<KnownObject> known = known_object(model, kNames[k]);
    if (!known) return fail(std::move(known.error()));
    out.push_back(std::move(*known));
  }
  if (with_tag) out[kBox].tag = ObjectTag{.id = kTag, .size = kTagSize, .X_OT = kTagOnBox};
  return out;
}

}  // namespace mjarm::perception::look_table
