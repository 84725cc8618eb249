// Formulas are read and evaluated by muParser. The only source that includes it.
#include "common/run/formula.hpp"

#include <muParser.h>

#include <cmath>

namespace common {

struct Parser : mu::Parser {
    double place[3]{};
};

void Formula::read(const std::vector<Constant>& constants, const std::string& variables) {
    variables_ = variables;
    if (is_number()) return;
    const std::string what = where_ + " = \"" + text_ + "\": ";
    for (std::size_t k = text_.find('='); k < text_.size(); k = text_.find('=', k + 1)) {
        const char before = k > 0 ? text_[k - 1] : ' ', after = text_[k + 1];
        if (after != '=' && std::string("<>!=").find(before) > 3)
            throw InputError(what + "'=' gives no value here; to compare, write '=='");
    }
    Parser& rule = *(parser_ = std::make_shared<Parser>());
    int values = 0;
    try {
        for (std::size_t k = 0; k < variables.size(); k += 3)
            rule.DefineVar({variables[k]}, &rule.place[k / 3]);
        rule.DefineConst("pi", 3.14159265358979323846);
        for (const auto& [name, value] : constants) {
            if (rule.GetVar().count(name) + rule.GetConst().count(name) +
                rule.GetFunDef().count(name))
                throw InputError("'constant." + name + "': the name means something already");
            rule.DefineConst(name, value);
        }
        rule.SetExpr(text_);
        rule.Eval(values);
    } catch (const mu::ParserError& error) {
        throw InputError(what + error.GetMsg() + "; known are " + variables +
                         ", pi, constants, sin, exp, min ..., a < b ? c : d");
    }
    if (values != 1) throw InputError(what + "write one value, without ',' outside of functions");
}

double Formula::at(double x, double z, double r) const {
    if (is_number()) return number_;
    parser_->place[0] = x, parser_->place[1] = z, parser_->place[2] = r;
    const double value = parser_->Eval();
    if (std::isfinite(value) && contains(allowed_, value)) return value;
    throw InputError(where_ + " = \"" + text_ + "\" is " + format(value) + " at " + variables_[0] +
                     " = " + format(x) + (variables_ == "v" ? "" : ", z = " + format(z)) +
                     "; allowed: finite, " + text_of(allowed_));
}

}  // namespace common
