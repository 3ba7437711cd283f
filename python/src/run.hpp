#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/stop.hpp"
#include "mjarm/execution/motion_run.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/render/plot.hpp"
#include "mjarm/render/trail.hpp"
#include "mjarm/session/picture.hpp"

namespace mjarm::python {

/// `mjarm.Run`: what was executed in a simulation, with all that tells and shows it.
class BoundRun {
 public:
  /// What a caller may choose.
  struct Choice {
    double rest = kRestAtEnd;  ///< [s] after the last motion
    double tolerance = 5e-4;   ///< [m] from curve and goal
  };

  /// Runs a plan without faults, by the control that its program asks for.
  [[nodiscard]] static Result<std::unique_ptr<BoundRun>> execute(program::LoadedProgram loaded,
                                                                 const Choice& choice,
                                                                 const StopCheck& stop);

  [[nodiscard]] const Report& report() const { return report_; }
  [[nodiscard]] const Recorder& recorder() const { return run_.recorder(); }
  [[nodiscard]] int dof() const { return loaded_.robot.arm.dof(); }
  /// (nq,) at its end.
  [[nodiscard]] std::span<const double> qpos() const { return run_.sim().qpos(); }
  /// Its page of charts.
  [[nodiscard]] render::Plot plot() const;
  /// The end of it.
  [[nodiscard]] Result<render::Image> picture(int width, int height) const;
  /// A video of it: it is run once more.
  [[nodiscard]] Result<std::string> film(const session::PictureOptions& options,
                                         const StopCheck& stop) const;
  /// The files that `mjarm run` writes.
  [[nodiscard]] Result<void> save(const std::filesystem::path& folder, bool overwrite) const;

 private:
  BoundRun(program::LoadedProgram loaded, const Choice& choice);
  [[nodiscard]] render::Camera camera(bool film, double aspect) const;
  [[nodiscard]] render::Overlay overlay() const;

  program::LoadedProgram loaded_;
  Choice choice_;
  MotionRun run_;
  render::Trail trail_{{.max_points = 10000, .pen = render::Pen::up}};
  std::vector<MeasuredRun> measured_ = {};
  Report report_ = {};
};

}  // namespace mjarm::python
