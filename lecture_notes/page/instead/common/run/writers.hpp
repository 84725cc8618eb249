// In the browser the columns of a table or of fields on a mesh go to the page, which draws them; what
// is written there as a file nobody would find. All else is as in common/run/writers.hpp.
#pragma once

#define write_table write_table_to_file
#define write_fields write_fields_to_file
#include_next "common/run/writers.hpp"
#undef write_table
#undef write_fields

namespace common {

/// Hands columns to the page, if a picture is due.
/// in: kind, such as particles; x and z, the axes of a mesh
void show_columns(const std::string& kind, const std::vector<ScalarColumn>& columns,
                  const SampledAxis& x = {}, const SampledAxis& z = {});

inline void write_table(const Snapshot&, const std::string& kind,
                        const std::vector<ScalarColumn>& columns) {
    show_columns(kind, columns);
}
inline void write_fields(const Snapshot&, const std::string& kind, const SampledAxis& x,
                         const SampledAxis& z, const std::vector<ScalarColumn>& fields) {
    show_columns(kind, fields, x, z);
}
inline void write_table(const std::string&, const std::vector<ScalarColumn>&) {}
inline void write_fields(const std::string&, const SampledAxis&, const SampledAxis&,
                         const std::vector<ScalarColumn>&) {}

}  // namespace common
