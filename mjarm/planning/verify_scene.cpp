#include <algorithm>
#include <limits>
#include <vector>

#include "mjarm/planning/verify_scene_internal.hpp"

namespace mjarm::detail {
namespace {

/// What is left of a problem where only a link and an obstacle, or two links, of these names
/// count. A link may be in several pieces.
std::pair<SphereSet, Obstacles> pieces_named(const SphereSet& set, const Obstacles& obstacles,
                                             const std::string& link, const std::string& other) {
  std::pair<SphereSet, Obstacles> out;
  auto& [links, solids] = out;
  std::vector<int> new_link(set.links.size(), -1);
  std::vector<int> new_solid(obstacles.solids.size(), -1);
  for (std::size_t i = 0; i < set.links.size(); ++i) {
    if (set.links[i].name != link && set.links[i].name != other) continue;
    new_link[i] = static_cast<int>(links.links.size());
    links.links.push_back(set.links[i]);
  }
  for (std::size_t i = 0; i < obstacles.solids.size(); ++i) {
    if (obstacles.solids[i].name != other) continue;
    new_solid[i] = static_cast<int>(solids.solids.size());
    solids.solids.push_back(obstacles.solids[i]);
  }
  for (const auto& [a, b] : set.pairs) {
    const int first = new_link[static_cast<std::size_t>(a)];
    const int second = new_link[static_cast<std::size_t>(b)];
    if (first < 0 || second < 0) continue;
    if (links.links[static_cast<std::size_t>(first)].name ==
        links.links[static_cast<std::size_t>(second)].name) {
      continue;
    }
    links.pairs.push_back({first, second});
  }
  for (const IgnoredPair& pair : obstacles.ignored) {
    const int first = new_link[static_cast<std::size_t>(pair.link)];
    const auto solid = static_cast<std::size_t>(pair.obstacle);
    const int second = solid < new_solid.size() ? new_solid[solid] : -1;
    if (first >= 0 && second >= 0) solids.ignored.push_back({first, second});
  }
  return out;
}

}  // namespace

std::pair<std::string, std::string> SphereVerifyScene::names(const VerifyResult& found) const {
  if (found.obstacle < 0) return {name_of(found.link), name_of(found.other_link)};
  const std::string& name = obstacle_name(problem_.obstacles, found.obstacle);
  return {name_of(found.link), name.empty() ? std::to_string(found.obstacle) : name};
}

Result<std::optional<double>> SphereVerifyScene::distance(const std::string& link,
                                                          const std::string& other, Row q) {
  const auto [links, solids] = pieces_named(file_.spheres, problem_.obstacles, link, other);
  const auto count = links.links.size() * solids.solids.size();
  if (count <= solids.ignored.size() && links.pairs.empty()) return std::nullopt;
  const Result<VerifyResult> found = verify_edge(
      file_.arm, links, solids, q, q, {.limit_slack = std::numeric_limits<double>::max()});
  if (!found) return fail(found.error());
  return found->distance;
}

Result<std::optional<EdgeContact>> SphereVerifyScene::contact(Row q0, Row q1,
                                                              const VerifyRules& rules) {
  if (!exact_) {
    Result<SphereModel> made = sphere_model(file_.arm, file_.spheres, problem_.obstacles);
    if (!made) return fail(std::move(made.error()));
    model_ = std::move(*made);
    exact_.emplace(model_->model, model_->arm,
                   ExactOptions{.margin = 0, .allow_depth = rules.allow_depth});
  }
  auto found = first_contact(*exact_, q0, q1, rules.step, rules.stop);
  if (!found || !*found) return found;
  GeomPair& pair = (*found)->contact.pair;
  pair.geom1 = model_->parts.at(pair.geom1);
  pair.geom2 = model_->parts.at(pair.geom2);
  return found;
}

}  // namespace mjarm::detail
