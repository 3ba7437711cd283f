#include "mjarm/execution/object_watch.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/core/messages/execution.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/object_shape.hpp"

namespace mjarm {
namespace {

constexpr double kFall = 0.02;  // [m] no less than is allowed

}  // namespace

std::string_view name(ObjectFault fault) noexcept {
  switch (fault) {
    case ObjectFault::lost:
      return "object_lost";
    case ObjectFault::moved:
      return "object_moved";
    case ObjectFault::touched:
      return "object_touched";
    case ObjectFault::none:
      break;
  }
  return "";
}

std::string describe(const ObservedObject& object) {
  if (object.fault == ObjectFault::touched) {
    return text(msg::execution_object_touched, object.name, object.touched, object.touched_at);
  }
  const Msg words = object.fell                         ? msg::execution_object_fell
                    : object.fault == ObjectFault::lost ? msg::execution_object_lost
                                                        : msg::execution_object_moved;
  return text(words, object.name, 1e3 * object.off_plan, object.at.value_or(0));
}

ObjectWatch::ObjectWatch(const Model& model, const MotionPlan& plan)
    : plan_(&plan), bodies_(scene_bodies(model, plan.arms.front())) {
  for (const SceneObject& object : bodies_.objects) {
    centers_.push_back(object_mass(model, object.body).center_B);
  }
  restart();
}

void ObjectWatch::restart() {
  tracks_.clear();
  first_contact_.reset();
  begun_ = false;
  for (const SceneObject& object : bodies_.objects) {
    Track& track = tracks_.emplace_back();
    track.seen.name = object.name;
    for (const PlannedMove& move : plan_->moves) {
      const auto found = std::ranges::find(move.attached, object.name, &AttachedBody::body);
      track.attached.push_back(found == move.attached.end() ? nullptr : &*found);
      if (track.attached.back() != nullptr) track.seen.carried = true;
    }
  }
}

ObjectWatch::Turn ObjectWatch::turn_at(const Track& track, std::size_t move) {
  const std::size_t count = track.attached.size();
  if (count == 0) return {};
  return {move > 0 ? track.attached[move - 1] : nullptr, track.attached[std::min(move, count - 1)]};
}

void ObjectWatch::look(const Sim& sim, std::size_t move, bool presses) {
  for (std::size_t i = 0; !begun_ && i < tracks_.size(); ++i) {
    tracks_[i].X_WB_first = tracks_[i].X_WB_plan = sim.body_pose(bodies_.objects[i].body);
  }
  begun_ = true;
  const auto object_of = [&](int body) {
    return bodies_.object_of[static_cast<std::size_t>(body)];
  };
  for (const Contact& contact : sim.contacts()) {
    if (contact.body1 < 0 || contact.body2 < 0) continue;
    if (!first_contact_ && !is_planned(contact, move, presses)) {
      first_contact_ = TimedContact{contact, sim.time()};
    }
    const int a = object_of(contact.body1), b = object_of(contact.body2);
    if (a >= 0) {
      note_object(static_cast<std::size_t>(a), contact.body2, contact.second, sim.time(), move);
    }
    if (b >= 0) {
      note_object(static_cast<std::size_t>(b), contact.body1, contact.first, sim.time(), move);
    }
  }
  for (std::size_t i = 0; i < tracks_.size(); ++i) compare(sim, move, i);
}

/// How far an object is from where the plan has it.
void ObjectWatch::compare(const Sim& sim, std::size_t move, std::size_t object) {
  Track& track = tracks_[object];
  const Arm& arm = plan_->arms.front();
  const Turn turn = turn_at(track, move);
  const Pose X_WB = sim.body_pose(bodies_.objects[object].body);
  track.seen.moved = (X_WB.p - track.X_WB_first.p).norm();
  if (turn.before != nullptr && turn.now == nullptr) {  // it is put down
    const Trajectory& still = plan_->moves[move].trajectory;
    track.X_WB_plan = fk(arm, as_span(still.at(0).q)) * turn.before->X_TB;
  }
  Pose planned = turn.now != nullptr ? sim.tool(arm) * turn.now->X_TB : track.X_WB_plan;
  if (turn.now != nullptr && !track.R_plan_true) {
    track.R_plan_true = planned.R.transpose() * X_WB.R;
  }
  // The gripper closes on it, or opens: where it goes meanwhile is shown by what follows.
  if ((turn.before == nullptr) != (turn.now == nullptr)) return;
  const double off = (X_WB * centers_[object] - planned * centers_[object]).norm();
  if (track.R_plan_true) planned.R *= *track.R_plan_true;
  const double turned = angle_between(planned.R, X_WB.R);
  ObservedObject& seen = track.seen;
  seen.off_plan = std::max(seen.off_plan, off);
  seen.turned = std::max(seen.turned, turned);
  seen.fell = seen.fell || planned.p.z() - X_WB.p.z() > kFall;
  const double max_off = seen.carried ? kCarriedPosition : kObjectPosition;
  const double max_turn = seen.carried ? kCarriedRotation : kObjectRotation;
  if (!seen.at && (off > max_off || turned > max_turn)) seen.at = sim.time();
}

/// Contacts of a tool that presses, of the hand with itself and with what it carries at some time,
/// of links that the arm does not move against each other, what overlaps by design, and all that
/// the arm has no part in. Of what is carried the end tells, when it is known what it was put on.
bool ObjectWatch::is_planned(const Contact& contact, std::size_t move, bool presses) const {
  const auto role = [&](int body) { return bodies_.role[static_cast<std::size_t>(body)]; };
  const auto is_arm = [](BodyRole r) { return r == BodyRole::link || r == BodyRole::hand; };
  const BodyRole a = role(contact.body1), b = role(contact.body2);
  if (!is_arm(a) && !is_arm(b)) return true;
  if (is_by_design(plan_->arms.front(), contact)) return true;
  const auto moved_by = [&](int body) { return bodies_.moved_by[static_cast<std::size_t>(body)]; };
  if (a == b && moved_by(contact.body1) == moved_by(contact.body2)) return true;
  if (is_allowed(contact, move)) return true;
  const int last = plan_->arms.front().dof();
  if (presses && (moved_by(contact.body1) == last) != (moved_by(contact.body2) == last))
    return true;
  const auto carried = [&](int body) {
    const int object = bodies_.object_of[static_cast<std::size_t>(body)];
    return object >= 0 && tracks_[static_cast<std::size_t>(object)].seen.carried;
  };
  return (a == BodyRole::hand && carried(contact.body2)) ||
         (b == BodyRole::hand && carried(contact.body1));
}

/// By the motion itself: what touches on behind it is a contact again.
bool ObjectWatch::is_allowed(const Contact& contact, std::size_t move) const {
  const auto is_of = [&](const std::string& name, const std::string& geom, int body) {
    return name == geom || name == bodies_.name[static_cast<std::size_t>(body)];
  };
  const auto is_pair = [&](const std::array<std::string, 2>& pair) {
    return (is_of(pair[0], contact.first, contact.body1) &&
            is_of(pair[1], contact.second, contact.body2)) ||
           (is_of(pair[1], contact.first, contact.body1) &&
            is_of(pair[0], contact.second, contact.body2));
  };
  return move < plan_->moves.size() && std::ranges::any_of(plan_->moves[move].allowed, is_pair);
}

void ObjectWatch::note_object(std::size_t object, int other_body, const std::string& other,
                              double time, std::size_t move) {
  Track& track = tracks_[object];
  const auto at = static_cast<std::size_t>(other_body);
  const BodyRole role = bodies_.role[at];
  if (role == BodyRole::link || role == BodyRole::hand) {
    track.disturbed = true;
    if (role == BodyRole::link || !track.seen.carried) track.touched.try_emplace(other, time);
    return;
  }
  if (role == BodyRole::object) {
    const Track& pusher = tracks_[static_cast<std::size_t>(bodies_.object_of[at])];
    track.disturbed = track.disturbed || pusher.disturbed;
  }
  if (turn_at(track, move).is_in_hand()) {
    track.touched.try_emplace(other, time);
  } else {
    track.rests_on.insert(other);
  }
}

std::vector<ObservedObject> ObjectWatch::objects() const {
  std::vector<ObservedObject> out;
  for (const Track& track : tracks_) {
    ObservedObject seen = track.seen;
    for (const auto& [other, time] : track.touched) {
      if (track.rests_on.contains(other)) continue;
      if (!seen.touched.empty() && time >= seen.touched_at) continue;
      seen.touched = other;
      seen.touched_at = time;
    }
    const bool known = seen.carried || track.disturbed;
    seen.by_itself = seen.at && !known;
    if (known && seen.at) seen.fault = seen.carried ? ObjectFault::lost : ObjectFault::moved;
    const bool first = !seen.at || seen.touched_at <= *seen.at;
    if (!seen.touched.empty() && first) seen.fault = ObjectFault::touched;
    if (seen.carried || seen.at || !seen.touched.empty()) out.push_back(std::move(seen));
  }
  return out;
}

}  // namespace mjarm
