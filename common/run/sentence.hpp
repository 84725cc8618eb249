// Sentences for the user, made of words and numbers.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "common/run/parameters.hpp"

namespace common {

/// Words and numbers in one text; real numbers with four digits.
template <class... Part>
std::string sentence(const Part&... parts) {
    std::string text;
    const auto add = [&](const auto& part) {
        if constexpr (std::is_integral_v<std::decay_t<decltype(part)>>)
            text += std::to_string(part);
        else if constexpr (std::is_convertible_v<decltype(part), double>)
            text += format(part);
        else
            text += part;
    };
    (add(parts), ...);
    return text;
}

/// Ends the program with a sentence where the input is bad. errors: InputError
template <class... Part>
void refuse(bool bad, const Part&... parts) {
    if (bad) throw InputError(sentence(parts...));
}

/// Ends the program with a sentence about a computation that failed. errors: NumericalError
template <class... Part>
[[noreturn]] void fail(const Part&... parts) {
    throw NumericalError(sentence(parts...));
}

/// Adds a sentence to the warnings where the input may mislead.
template <class... Part>
void warn(std::vector<std::string>& warnings, bool doubtful, const Part&... parts) {
    if (doubtful) warnings.push_back(sentence(parts...));
}

}  // namespace common
