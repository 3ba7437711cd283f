#include "apps/bench/pick_seen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/pick.hpp"
#include "apps/bench/suite.hpp"
#include "apps/mjarm/cli/table.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/perception/look_table.hpp"
#include "mjarm/perception/tag_detector.hpp"

namespace mjarm::app {
namespace {

namespace look_table = perception::look_table;

constexpr std::array kShapes{look_table::kBox, look_table::kCan, look_table::kStep};

/// What it is known by, and at which noise, in words.
std::string way_of(const SeenErrors& errors) {
  return text(errors.by_tag ? msg::bench_seen_tag : msg::bench_seen_shape);
}
std::string noise_of(const SeenErrors& errors) {
  return errors.depth_sigma > 0 ? text(msg::bench_seen_sigma, 1e3 * errors.depth_sigma)
                                : text(msg::bench_seen_none);
}

/// Adds what a look tells of one object.
/// @param X_WB  where it is; none: it is not there.
void judge(const perception::FoundObject& found, const std::optional<Pose>& X_WB,
           std::uint64_t placement, SeenErrors& out) {
  if (X_WB) ++out.placements;
  if (!found.pose) {
    if (X_WB) out.missed.push_back({placement, perception::describe(found.pose.error().code)});
    return;
  }
  if (!X_WB) {
    out.wrong.push_back({placement, text(msg::bench_seen_invented)});
    return;
  }
  const Pose& seen = found.pose->X_WO;
  out.position.push_back((seen.p - X_WB->p).norm());
  out.rotation.push_back(out.by_tag ? angle_between(seen.R, X_WB->R)
                                    : turn_between(out.object, seen.R, X_WB->R));
  const double off = out.position.back(), turn = out.rotation.back();
  // Not a number is wrong as well.
  if (off <= out.position_goal() && turn <= out.rotation_goal()) return;
  out.wrong.push_back({placement, text(msg::bench_seen_off, 1e3 * off, in_degrees(turn))});
}

/// All that is seen with one camera.
class SeenTrial {
 public:
  static Result<SeenTrial> open(double depth_sigma) {
    Result<look_table::Table> table = look_table::Table::open({.depth_sigma = depth_sigma});
    if (!table) return fail(std::move(table.error()));
    SeenTrial out(std::move(*table));
    for (const bool by_tag : {true, false}) {
      if (by_tag && !perception::has_tags()) continue;
      auto objects = look_table::objects(out.table_.model(), by_tag);
      if (!objects) return fail(std::move(objects.error()));
      for (const look_table::Body body : kShapes) {
        if (by_tag && body != look_table::kBox) continue;
        out.errors_.push_back(
            {.object = (*objects)[body].name, .by_tag = by_tag, .depth_sigma = depth_sigma});
      }
      auto finder =
          perception::ObjectFinder::create(std::move(*objects), {.depth_sigma = depth_sigma});
      if (!finder) return fail(std::move(finder.error()));
      (by_tag ? out.by_tag_ : out.by_shape_) = std::move(*finder);
    }
    return out;
  }

  /// Each of the objects once: in one look, or in one each where they would hide each other.
  Result<void> place(std::uint64_t seed, std::uint64_t placement) {
    for (const look_table::Body body : kShapes) {
      Rng rng(seed, placement);
      const look_table::Places places = look_table::random_places(rng, body);
      const auto there = std::ranges::count_if(
          places.bodies, [](const std::optional<Pose>& one) { return one.has_value(); });
      const Result<render::RgbdFrame> frame = table_.look(places, rng);
      if (!frame) return fail(frame.error());
      auto errors = errors_.begin();
      if (by_tag_) {
        if (body == look_table::kBox) {
          const auto found = by_tag_->find(*frame);
          if (!found) return fail(found.error());
          judge(found->objects[body], places.bodies[body], placement, *errors);
        }
        ++errors;
      }
      const auto found = by_shape_->find(*frame);
      if (!found) return fail(found.error());
      for (const look_table::Body one : kShapes) {
        judge(found->objects[one], places.bodies[one], placement, *errors++);
      }
      if (there > 1) break;
    }
    return {};
  }

  [[nodiscard]] const std::vector<SeenErrors>& errors() const { return errors_; }

 private:
  explicit SeenTrial(look_table::Table table) : table_(std::move(table)) {}

  look_table::Table table_;
  std::optional<perception::ObjectFinder> by_tag_, by_shape_;
  std::vector<SeenErrors> errors_;  ///< first the box by its tag, where it is known by it
};

/// "0.04 / 0.11"
std::string median_and_max(const std::vector<double>& values, double unit) {
  if (values.empty()) return "-";
  return fmt::format("{:.2f} / {:.2f}", percentile(values, 50) / unit,
                     *std::ranges::max_element(values) / unit);
}

}  // namespace

double SeenErrors::rotation_goal() const { return by_tag ? kRadPerDeg : 2 * kRadPerDeg; }

Result<std::vector<SeenErrors>> measure_seen(const SceneNumbers& placements, std::uint64_t seed) {
  constexpr std::array kSigmas = {render::RgbdOptions{}.depth_sigma, 0.0};
  Progress progress(text(msg::bench_seen_progress),
                    kSigmas.size() * static_cast<std::size_t>(placements.count));
  std::vector<SeenErrors> out;
  for (const double sigma : kSigmas) {
    Result<SeenTrial> trial = SeenTrial::open(sigma);
    if (!trial) return fail(std::move(trial.error()));
    for (int i = 0; i < placements.count; ++i) {
      if (interrupted()) return fail(stopped());
      Result<void> done = trial->place(seed, placements.number(i));
      if (!done) return fail(std::move(done.error()));
      progress.advance();
    }
    std::ranges::copy(trial->errors(), std::back_inserter(out));
  }
  return out;
}

std::string seen_table(std::span<const SeenErrors> errors) {
  std::vector<std::vector<std::string>> rows{
      {text(msg::bench_seen_object), text(msg::bench_seen_way), text(msg::bench_seen_noise),
       text(msg::bench_seen_found), text(msg::bench_seen_position), text(msg::bench_seen_rotation),
       text(msg::bench_seen_goal), text(msg::bench_seen_wrong)}};
  std::string faults;
  const auto tell = [&](const SeenErrors& one, const std::vector<SeenFault>& all, Msg line) {
    for (const SeenFault& fault : all) {
      faults += text(line, one.object, way_of(one), noise_of(one), fault.placement, fault.what);
      faults += '\n';
    }
  };
  for (const SeenErrors& one : errors) {
    rows.push_back({one.object, way_of(one), noise_of(one),
                    fmt::format("{}/{}", one.position.size(), one.placements),
                    median_and_max(one.position, 1e-3), median_and_max(one.rotation, kRadPerDeg),
                    fmt::format("{:g} mm, {:g} deg", 1e3 * one.position_goal(),
                                in_degrees(one.rotation_goal())),
                    std::to_string(one.wrong.size())});
    tell(one, one.missed, msg::bench_seen_miss);
    tell(one, one.wrong, msg::bench_seen_wrong_pose);
  }
  if (!perception::has_tags()) faults += text(msg::bench_seen_no_tags) + '\n';
  std::string out = markdown_table(rows);
  return faults.empty() ? out : out + '\n' + faults;
}

JsonDoc seen_json(std::span<const SeenErrors> errors) {
  const auto to_json = [](const std::vector<SeenFault>& faults) {
    std::vector<JsonDoc> out;
    for (const SeenFault& fault : faults) {
      out.push_back(
          {{"placement", static_cast<std::size_t>(fault.placement)}, {"what", fault.what}});
    }
    return out;
  };
  std::vector<JsonDoc> out;
  for (const SeenErrors& one : errors) {
    out.push_back({{"object", one.object},
                   {"by_tag", one.by_tag},
                   {"depth_sigma", one.depth_sigma},
                   {"placements", one.placements},
                   {"position_goal", one.position_goal()},
                   {"rotation_goal", one.rotation_goal()},
                   {"position", one.position},
                   {"rotation", one.rotation},
                   {"missed", to_json(one.missed)},
                   {"wrong", to_json(one.wrong)}});
  }
  return out;
}

}  // namespace mjarm::app
