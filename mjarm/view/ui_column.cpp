#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>

#include "mjarm/view/ui_column_internal.hpp"
#include "mjarm/view/ui_labels_internal.hpp"

namespace mjarm::view {
namespace {

constexpr int kWidth = 300;  // of a plain screen's pixels
constexpr int kLabelWidth = 150;
constexpr int kListLines = 30;  // mjMAXUIMULTI is the most
constexpr int kSliderDivisions = 2000;

/// At most N - 1 characters that MuJoCo's font has; never empty, which it does not take. Other
/// texts leave a blank: `render` draws them.
template <std::size_t N>
void copy_ascii(char (&target)[N], std::string_view text) {
  if (!is_ascii(text)) text = " ";
  std::size_t length = 0;
  for (const char c : text.substr(0, N - 1)) target[length++] = c >= 32 && c < 127 ? c : '?';
  target[length] = '\0';
}

void set_words(mjuiItem& item, const std::vector<std::string>& words, int first) {
  const int count = static_cast<int>(words.size()) - first;
  item.multi.nelem = std::clamp(count, 1, std::min(mjMAXUIMULTI, kListLines + 5));
  for (int i = 0; i < item.multi.nelem; ++i) {
    const auto word = static_cast<std::size_t>(first + i);
    copy_ascii(item.multi.name[i], word < words.size() ? std::string_view(words[word]) : "");
  }
}

bool same_item(const PanelItem& a, const PanelItem& b) {
  if (a.id != b.id || a.name != b.name || a.enabled != b.enabled ||
      a.what.index() != b.what.index()) {
    return false;
  }
  if (const auto* x = std::get_if<PanelSlider>(&a.what)) {
    const auto& y = std::get<PanelSlider>(b.what);
    return x->lower == y.lower && x->upper == y.upper;
  }
  if (const auto* x = std::get_if<PanelTimeline>(&a.what)) {
    return x->end == std::get<PanelTimeline>(b.what).end;
  }
  if (const auto* x = std::get_if<PanelChoice>(&a.what)) {
    return x->words == std::get<PanelChoice>(b.what).words;
  }
  if (const auto* x = std::get_if<PanelList>(&a.what)) {
    return x->lines.size() == std::get<PanelList>(b.what).lines.size();
  }
  return true;
}

bool same_structure(const std::vector<PanelSection>& a, const std::vector<PanelSection>& b) {
  return std::equal(
      a.begin(), a.end(), b.begin(), b.end(), [](const PanelSection& x, const PanelSection& y) {
        return x.title == y.title && std::equal(x.items.begin(), x.items.end(), y.items.begin(),
                                                y.items.end(), same_item);
      });
}

/// The first line that is shown, so that the current one is among those in the middle.
int first_line(const PanelList& list) {
  const int spare = static_cast<int>(list.lines.size()) - kListLines;
  return std::clamp(list.current - kListLines / 2, 0, std::max(spare, 0));
}

mjuiDef definition(int type, std::string_view name) {
  mjuiDef def{};
  def.type = type;
  copy_ascii(def.name, name);
  def.state = 1;
  return def;
}

void set_range(mjuiDef& def, double lower, double upper) {
  if (!std::isfinite(lower) || !std::isfinite(upper)) lower = upper = 0;
  if (!(lower < upper)) upper = lower + 1;
  std::snprintf(def.other, sizeof(def.other), "%.17g %.17g %d", lower, upper, kSliderDivisions);
}

}  // namespace

UiColumn::UiColumn(int rect) : ui_(std::make_unique<mjUI>()) {
  ui_->spacing = mjui_themeSpacing(0);
  ui_->spacing.total = kWidth;
  ui_->spacing.label = kLabelWidth;
  ui_->spacing.samples = 0;  // smooth corners are not worth a slower start
  ui_->color = mjui_themeColor(1);
  ui_->rectid = ui_->auxid = rect;
  ui_->radiocol = 1;
}

void UiColumn::add_item(const PanelItem& item, Cell& cell) {
  mjuiDef defs[2] = {definition(mjITEM_STATIC, item.name), definition(mjITEM_END, "")};
  mjuiDef& def = defs[0];
  def.state = item.enabled ? 1 : 0;
  if (std::holds_alternative<PanelButton>(item.what)) {
    def.type = mjITEM_BUTTON;
  } else if (std::holds_alternative<PanelCheckbox>(item.what)) {
    def.type = mjITEM_CHECKINT;
    def.pdata = &cell.integer;
  } else if (const auto* slider = std::get_if<PanelSlider>(&item.what)) {
    def.type = mjITEM_SLIDERNUM;
    def.pdata = &cell.number;
    set_range(def, slider->lower, slider->upper);
  } else if (const auto* timeline = std::get_if<PanelTimeline>(&item.what)) {
    def.type = mjITEM_SLIDERNUM;
    def.pdata = &cell.number;
    def.name[0] = '\0';
    set_range(def, 0, timeline->end);
  } else if (std::holds_alternative<PanelChoice>(item.what)) {
    def.type = mjITEM_SELECT;
    def.pdata = &cell.integer;
  } else if (std::holds_alternative<PanelList>(item.what)) {
    def.type = mjITEM_RADIO;
    def.pdata = &cell.integer;
    def.name[0] = '\0';
  }
  mjui_add(ui_.get(), defs);
  mjuiSection& section = ui_->sect[ui_->nsect - 1];
  mjuiItem& drawn = section.item[section.nitem - 1];
  if (const auto* choice = std::get_if<PanelChoice>(&item.what)) set_words(drawn, choice->words, 0);
  (void)write(item, cell, drawn);
}

void UiColumn::build(const std::vector<PanelSection>& sections) {
  // A section that was there keeps whether it is open.
  const auto state_of = [this](const PanelSection& wanted) {
    for (std::size_t i = 0; i < sections_.size() && i < static_cast<std::size_t>(ui_->nsect); ++i) {
      if (sections_[i].title == wanted.title) return ui_->sect[i].state;
    }
    return static_cast<int>(wanted.open ? mjSECT_OPEN : mjSECT_CLOSED);
  };
  std::vector<int> states;
  for (const PanelSection& section : sections) states.push_back(state_of(section));
  ui_->nsect = 0;
  ui_->mousesect = ui_->editsect = 0;
  sections_ = sections;
  if (sections_.size() > mjMAXUISECT) sections_.resize(mjMAXUISECT);
  cells_.assign(sections_.size(), {});
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    mjuiDef title[2] = {definition(mjITEM_SECTION, sections_[i].title), definition(mjITEM_END, "")};
    title[0].name[mjMAXUINAME - 2] = '\0';  // MuJoCo takes one less here
    title[0].state = states[i];
    mjui_add(ui_.get(), title);
    std::vector<PanelItem>& items = sections_[i].items;
    if (items.size() > mjMAXUIITEM) items.resize(mjMAXUIITEM);
    for (const PanelItem& item : items) add_item(item, cells_[i].emplace_back());
  }
}

bool UiColumn::write(const PanelItem& item, Cell& cell, mjuiItem& drawn) {
  std::string printed;
  if (const auto* checkbox = std::get_if<PanelCheckbox>(&item.what)) {
    cell.integer = checkbox->on ? 1 : 0;
    printed = checkbox->on ? "1" : "0";
  } else if (const auto* slider = std::get_if<PanelSlider>(&item.what)) {
    cell.number = slider->value;
  } else if (const auto* timeline = std::get_if<PanelTimeline>(&item.what)) {
    cell.number = timeline->time;
  } else if (const auto* choice = std::get_if<PanelChoice>(&item.what)) {
    cell.integer = std::clamp(choice->current, 0, std::max(drawn.multi.nelem - 1, 0));
    printed = std::to_string(cell.integer);
  } else if (const auto* list = std::get_if<PanelList>(&item.what)) {
    cell.first = first_line(*list);
    set_words(drawn, list->lines, cell.first);
    drawn.multi.nelem = std::min(drawn.multi.nelem, kListLines);
    cell.integer = std::clamp(list->current - cell.first, 0, drawn.multi.nelem - 1);
    printed = std::to_string(list->current);
    for (const std::string& line : list->lines) printed += "\n" + line;
  } else if (const auto* line = std::get_if<PanelText>(&item.what)) {
    drawn.multi.nelem = 1;
    copy_ascii(drawn.multi.name[0], line->value);
    printed = line->value;
  }
  if (drawn.type == mjITEM_SLIDERNUM) {
    char number[32];
    std::snprintf(number, sizeof(number), "%.3g", cell.number);
    printed = number;
  }
  return std::exchange(cell.printed, printed) != printed;
}

bool UiColumn::is_held(int section, int item) const {
  return ui_->mousesect == section + 1 && ui_->mouseitem == item;
}

void UiColumn::show(const std::vector<PanelSection>& sections, mjuiState& state,
                    mjrContext& context) {
  if (ui_->nsect == 0 || !same_structure(sections, sections_)) {
    build(sections);
    refresh(state, context);
    return;
  }
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    for (std::size_t k = 0; k < sections_[i].items.size(); ++k) {
      const int section = static_cast<int>(i);
      const int item = static_cast<int>(k);
      if (is_held(section, item)) continue;
      sections_[i].items[k].what = sections[i].items[k].what;
      if (!write(sections[i].items[k], cells_[i][k], ui_->sect[i].item[k])) continue;
      mjui_update(section, item, ui_.get(), &state, &context);
    }
  }
}

void UiColumn::refresh(mjuiState& state, mjrContext& context) {
  mjui_resize(ui_.get(), &context);
  const int id = ui_->auxid;
  if (context.auxFBO[id] == 0 || context.auxWidth[id] != ui_->width ||
      context.auxHeight[id] != ui_->maxheight) {
    mjr_addAux(id, ui_->width, ui_->maxheight, ui_->spacing.samples, &context);
  }
  mjui_update(-1, -1, ui_.get(), &state, &context);
}

std::optional<UiChange> UiColumn::handle(mjuiState& state, const mjrContext& context) {
  const mjuiItem* changed = mjui_event(ui_.get(), &state, &context);
  if (changed == nullptr) return {};
  const auto section = static_cast<std::size_t>(changed->sectionid);
  const auto item = static_cast<std::size_t>(changed->itemid);
  Cell& cell = cells_[section][item];
  UiChange change{changed->sectionid, changed->itemid, 1};
  if (changed->type == mjITEM_SLIDERNUM) change.value = cell.number;
  if (changed->type == mjITEM_CHECKINT || changed->type == mjITEM_SELECT) {
    change.value = cell.integer;
  }
  if (changed->type == mjITEM_RADIO) change.value = cell.integer + cell.first;
  cell.printed.clear();  // what the application says next is drawn
  return change;
}

void UiColumn::render(const mjuiState& state, const mjrContext& context, GlyphFont& font) {
  mjui_render(ui_.get(), &state, &context);
  std::vector<std::vector<int>> first_lines;
  for (const std::deque<Cell>& cells : cells_) {
    std::vector<int>& lines = first_lines.emplace_back();
    for (const Cell& cell : cells) lines.push_back(cell.first);
  }
  draw_labels({*ui_, sections_, first_lines}, state, context, font);
}

std::optional<mjrRect> UiColumn::place(int section, int item, const mjuiState& state) const {
  if (section < 0 || section >= ui_->nsect || item >= ui_->sect[section].nitem) return {};
  const mjuiSection& drawn = ui_->sect[section];
  if (item >= 0 && drawn.state == mjSECT_CLOSED) return {};
  mjrRect rect = item < 0 ? drawn.rtitle : drawn.item[item].rect;
  const mjrRect& whole = state.rect[ui_->rectid];
  rect.left += whole.left;
  rect.bottom += whole.bottom + whole.height - ui_->height + ui_->scroll;
  return rect;
}

}  // namespace mjarm::view
