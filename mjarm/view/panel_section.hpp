#pragma once

#include <string>
#include <variant>
#include <vector>

namespace mjarm::view {

/// What a panel of a window shows: plain data that the application hands over with every frame.
/// What the user does with it comes back as a `PanelEvent`; the application decides what it means
/// and shows it with the next frames. Names are UTF-8, cut where their
/// place ends.

/// The value of its event is 1. Two in a row stand beside each other.
struct PanelButton {};
/// The value of its event is 0 or 1. Two in a row stand beside each other.
struct PanelCheckbox {
  bool on = false;
};
/// The value of its event is where it was moved. Without a name it is as wide as the panel.
struct PanelSlider {
  double value = 0;
  double lower = 0;
  double upper = 1;
};
/// A line of text; no event.
struct PanelText {
  std::string value = {};
};
/// One of a few words, in a menu; the value of its event is the index of the chosen one.
struct PanelChoice {
  std::vector<std::string> words = {};  ///< 1 to 35
  int current = 0;
};
/// Lines below each other of which one is the current one (a program); the value of its event is
/// the index of the line that was clicked. Of more than 30 those round the current one are shown.
struct PanelList {
  std::vector<std::string> lines = {};
  int current = 0;
};
/// A line in time, as wide as the panel; the value of its event is the time it was moved to.
struct PanelTimeline {
  double time = 0;  ///< [s]
  double end = 1;   ///< [s] > 0
};

/// One line of a panel.
struct PanelItem {
  int id = 0;  ///< the application's own number; comes back with the event
  std::string name = {};
  std::variant<PanelButton, PanelCheckbox, PanelSlider, PanelText, PanelChoice, PanelList,
               PanelTimeline>
      what = {};
  bool enabled = true;  ///< grey and without events where not
};

/// A part of a panel with a title, which the user folds away and back. A panel has room for 8
/// sections of the application and for 200 items in each; what is beyond is left out.
struct PanelSection {
  std::string title = {};
  std::vector<PanelItem> items = {};
  bool open = true;  ///< at first
};

}  // namespace mjarm::view
