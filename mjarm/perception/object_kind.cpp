#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "mjarm/perception/object_kind_internal.hpp"
#include "mjarm/perception/shape_search_internal.hpp"

namespace mjarm::perception {
namespace {

/// Which piece gets which name.
struct Named {
  std::size_t piece = 0, name = 0;
};

/// The pair that is nearest, of names that are believed to be anywhere; else the first of both.
Named nearest_pair(const std::vector<Eigen::Vector3d>& pieces,
                   const std::vector<std::optional<Eigen::Vector3d>>& names) {
  Named out;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      const double far = names[i] ? (pieces[k] - *names[i]).norm() : least;
      if (far >= least) continue;
      least = far;
      out = {k, i};
    }
  }
  return out;
}

template <class T>
void drop(std::vector<T>& list, std::size_t i) {
  list.erase(list.begin() + static_cast<std::ptrdiff_t>(i));
}

}  // namespace

void ObjectKind::begin() {
  found_.clear();
  doubtful_.clear();
}

bool ObjectKind::is_one_piece(const Pose& A, const Pose& B) const {
  const double apart = (A * shape.centre - B * shape.centre).norm();
  return apart < 2 * shape.inner || is_same(shape, A, B);
}

bool ObjectKind::is_found(const Pose& X_WO) const {
  return std::ranges::any_of(found_,
                             [&](const FoundPose& one) { return is_one_piece(one.X_WO, X_WO); });
}

void ObjectKind::add(const FoundPose& found) {
  std::erase_if(doubtful_, [&](const FindFailure& other) {
    return is_one_piece(other.best->X_WO, found.X_WO);
  });
  found_.push_back(found);
}

void ObjectKind::add_doubtful(FindErrc code, const FoundPose& best) {
  std::erase_if(doubtful_, [&](const FindFailure& other) {
    return is_one_piece(other.best->X_WO, best.X_WO);
  });
  doubtful_.push_back({.code = code, .best = best});
}

void ObjectKind::add_touching(const FoundPose& best) {
  const bool known = std::ranges::any_of(doubtful_, [&](const FindFailure& other) {
    return is_one_piece(other.best->X_WO, best.X_WO);
  });
  if (known || doubtful_.size() >= left()) return;
  doubtful_.insert(doubtful_.begin(), {.code = FindErrc::touching, .best = best});
}

void ObjectKind::name_pieces(std::span<const std::optional<Pose>> believed,
                             std::vector<ObjectPose>& out) const {
  std::vector<std::size_t> free = objects;
  std::vector<std::optional<Eigen::Vector3d>> names;
  for (const std::size_t i : objects) {
    const bool any = !believed.empty() && believed[i];
    names.push_back(any ? std::optional(*believed[i] * shape.centre) : std::nullopt);
  }
  const auto give = [&](std::vector<ObjectPose> poses, std::vector<Eigen::Vector3d> centres) {
    while (!poses.empty()) {
      const Named pair = nearest_pair(centres, names);
      out[free[pair.name]] = poses[pair.piece];
      drop(poses, pair.piece);
      drop(centres, pair.piece);
      drop(free, pair.name);
      drop(names, pair.name);
    }
  };
  std::vector<ObjectPose> poses;
  std::vector<Eigen::Vector3d> centres;
  for (const FoundPose& one : found_) {
    poses.emplace_back(one);
    centres.emplace_back(one.X_WO * shape.centre);
  }
  give(std::exchange(poses, {}), std::exchange(centres, {}));
  for (std::size_t k = doubtful_.size(); k > 0 && poses.size() < free.size(); --k) {
    poses.push_back(fail(doubtful_[k - 1]));
    centres.emplace_back(doubtful_[k - 1].best->X_WO * shape.centre);
  }
  give(std::move(poses), std::move(centres));
}

std::vector<ObjectKind> object_kinds(std::span<const KnownObject> objects) {
  std::vector<ObjectKind> out;
  std::map<std::string, std::size_t> known;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const auto [kind, is_new] = known.try_emplace(objects[i].kind, out.size());
    if (is_new || objects[i].kind.empty()) {
      kind->second = out.size();
      out.emplace_back(objects[i].surface);
    }
    out[kind->second].objects.push_back(i);
  }
  return out;
}

}  // namespace mjarm::perception
