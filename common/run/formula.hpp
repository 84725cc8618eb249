// A parameter that may differ from place to place: a number, or a formula such as
// "1 + .1*sin(2*pi*x)" or "x + z < 0 ? 1 : .125".
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/run/parameters.hpp"

namespace common {

/// A name that formulas may use for a number.
struct Constant {
    std::string name;
    double value = 0;
};
inline void describe_constant(ParameterTable& table, const std::string& prefix, Constant& c) {
    table.real(prefix + ".value", c.value, "", anything(), "of the name");
}

class Formula {
   public:
    Formula(double number = 0) : number_(number) {}
    /// in: where, the place and the name of the parameter, for messages
    Formula(const std::string& text, const std::string& where, Range allowed)
        : text_(text), where_(where), allowed_(allowed) {}

    const std::string& text() const { return text_; }
    bool is_number() const { return text_.empty(); }
    /// errors: InputError for a formula
    operator double() const {
        if (is_number()) return number_;
        throw InputError(where_ + ": a formula, where this run needs a number: write one");
    }

    /// Reads the text. Its names are x, z, r (the distance from a center), or the letters of such a
    /// list, pi and the constants. errors: InputError with the place and the cure
    void read(const std::vector<Constant>& constants, const std::string& variables = "x, z, r");
    /// The value where x, z, r, or the only variable, have these values; by one thread at a time.
    /// errors: InputError with the place where it is not finite or out of range
    double at(double x, double z = 0, double r = 0) const;

   private:
    double number_ = 0;
    std::string text_, where_, variables_;
    Range allowed_{};
    std::shared_ptr<struct Parser> parser_;
};

}  // namespace common
