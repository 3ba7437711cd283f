// Where a box and a can stand, from one look of an RGB-D camera.
#include <cstdio>

#include "mjarm/perception/find_objects.hpp"
#include "mjarm/render/rgbd.hpp"

constexpr const char* kScene = R"(
<mujoco>
  <worldbody>
    <light pos="0 0 2"/>
    <camera name="eye" pos="0.4 -0.3 0.5" xyaxes="0.6 0.8 0 -0.52 0.39 0.76" fovy="45"/>
    <geom type="box" size="0.4 0.4 0.02" pos="0 0 -0.02"/>
    <body name="box" pos="0.05 0.02 0.03" euler="0 0 30">
      <freejoint/><geom type="box" size="0.05 0.04 0.03" rgba="0.8 0.3 0.2 1"/></body>
    <body name="can" pos="-0.1 0.05 0.05">
      <freejoint/><geom type="cylinder" size="0.033 0.05" rgba="0.2 0.5 0.3 1"/></body>
  </worldbody>
</mujoco>)";

int main() {
  using namespace mjarm;
  const auto model = Model::from_mjcf(kScene);
  if (!model) return std::fprintf(stderr, "%s\n", model.error().what.c_str()), 1;
  auto camera = render::RgbdCamera::create(*model, "eye");
  if (!camera && camera.error().code == Errc::not_available) {
    return std::printf("no picture on this machine: %s\n", camera.error().what.c_str()), 0;
  }
  if (!camera) return std::fprintf(stderr, "%s\n", camera.error().what.c_str()), 1;
  Rng noise(1);
  const auto frame = camera->look({}, noise);  // the model as it starts
  if (!frame) return std::fprintf(stderr, "%s\n", frame.error().what.c_str()), 1;

  auto finder = perception::ObjectFinder::create(
      {*perception::known_object(*model, "box"), *perception::known_object(*model, "can")});
  if (!finder) return std::fprintf(stderr, "%s\n", finder.error().what.c_str()), 1;
  const auto scene = finder->find(*frame);
  if (!scene) return std::fprintf(stderr, "%s\n", scene.error().what.c_str()), 1;
  for (const auto& [name, pose] : scene->objects) {
    if (!pose)
      return std::fprintf(stderr, "%s: %s\n", name.c_str(), describe(pose.error().code).c_str()), 1;
    const Eigen::Vector3d& p = pose->X_WO.p;
    std::printf("%s at %.4f %.4f %.4f m, %.0f %% of it seen\n", name.c_str(), p.x(), p.y(), p.z(),
                100 * pose->seen);
  }
}
