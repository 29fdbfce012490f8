#include "standards/table_key.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/errors.h"
#include "scene/io/nearest_name.h"

namespace lightwell {

void refuse_key(const AskedKey& asked, const std::vector<std::string>& known) {
  throw InputError(fmt::format(
      "{}: there is no {} '{}'.{} The table has {}; '{} FILE' reads another table.", asked.asked_by,
      asked.noun, asked.key, did_you_mean(asked.key, known), fmt::join(known, ", "), asked.option));
}

}  // namespace lightwell
