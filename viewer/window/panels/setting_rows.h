// Settings as rows of the panel: what they say, their words and their range are those of the table.
#pragma once

#include <string>
#include <string_view>

#include "options/settings_names.h"
#include "window/panels/ui.h"

namespace tenebra::viewer {

/// The label and the help of the setting called `name`; the next widget fills the right column.
void setting_row(const Ui& ui, const char* label, std::string_view name);

/// That row with buttons for the setting's words; the widgets' marks are `mark`.WORD.
void edit_words(Ui& ui, MethodOptions& method, const char* label, std::string_view name,
                const std::string& mark);

/// That row with a field for a whole number within the setting's range.
void edit_number(Ui& ui, MethodOptions& method, const char* label, std::string_view name, const char* mark,
                 int step);

/// A field for a whole number alone. True if it was changed.
bool number_field(Ui& ui, const char* mark, int& value, int low, int high, int step);

}  // namespace tenebra::viewer
