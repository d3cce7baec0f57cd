// Columns of tables and fields of rows. Each row lists its columns once (columns()); statements, binding and
// reading follow from the list. Every row carries a sum of its columns: a row that was changed by anything
// but the farm is recognised, and does not count.
#pragma once

#include "bakerd/map/digest.h"

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>

#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace drtv::farm {

template <class Self, class Struct>
concept Is = std::same_as<std::remove_const_t<Self>, Struct>;

// A list of sentences in one column: one per line, for no sentence has a line's end.
[[nodiscard]] std::string joined(const std::vector<std::string>& sentences);
[[nodiscard]] std::vector<std::string> split(const std::string& text);

// The names of columns.
class ColumnNames {
  public:
    void operator()(std::string_view name, const auto&) { names_.emplace_back(name); }

    // "a, b", ":a, :b" and "a = :a, b = :b".
    [[nodiscard]] std::string list(const std::string& prefix = "") const;
    [[nodiscard]] std::string assignments() const;

  private:
    std::vector<std::string> names_;
};

// Binds a row to a statement's parameters of its columns' names.
class RowBinder {
  public:
    explicit RowBinder(SQLite::Statement& statement) : statement_(statement) {}

    template <std::integral Integer>
    void operator()(std::string_view name, const Integer& value) {
        statement_.bind(key(name), static_cast<std::int64_t>(value));
    }
    template <class Enum>
    requires std::is_enum_v<Enum>
    void operator()(std::string_view name, const Enum& value) {
        statement_.bind(key(name), static_cast<std::int64_t>(value));
    }
    template <std::floating_point Real>
    void operator()(std::string_view name, const Real& value) {
        statement_.bind(key(name), static_cast<double>(value));
    }
    void operator()(std::string_view name, const std::string& value) { statement_.bind(key(name), value); }
    void operator()(std::string_view name, const map::Digest& value) {
        statement_.bind(key(name), to_hex(value));
    }
    void operator()(std::string_view name, const std::vector<std::string>& value) {
        statement_.bind(key(name), joined(value));
    }
    template <class Value>
    void operator()(std::string_view name, const std::optional<Value>& value) {
        if (value)
            (*this)(name, *value);
        else
            statement_.bind(key(name));
    }

  private:
    static std::string key(std::string_view name) { return ":" + std::string(name); }

    SQLite::Statement& statement_;
};

// Reads a row of a statement that selects its columns in their order.
class RowReader {
  public:
    explicit RowReader(SQLite::Statement& statement) : statement_(statement) {}

    template <std::integral Integer>
    void operator()(std::string_view, Integer& value) {
        value = static_cast<Integer>(next().getInt64());
    }
    template <class Enum>
    requires std::is_enum_v<Enum>
    void operator()(std::string_view, Enum& value) { value = static_cast<Enum>(next().getInt64()); }
    template <std::floating_point Real>
    void operator()(std::string_view, Real& value) {
        value = static_cast<Real>(next().getDouble());
    }
    void operator()(std::string_view, std::string& value) { value = next().getString(); }
    void operator()(std::string_view, map::Digest& value) {
        value = map::digest_from_hex(next().getString()).value_or(map::Digest{});
    }
    void operator()(std::string_view, std::vector<std::string>& value) { value = split(next().getString()); }
    template <class Value>
    void operator()(std::string_view name, std::optional<Value>& value) {
        if (statement_.getColumn(column_).isNull())
            static_cast<void>(next());
        else
            (*this)(name, value.emplace());
    }

    // Whether the columns are those that were written: the one after them says so.
    [[nodiscard]] bool sound() { return next().getInt64() == 1; }

  private:
    SQLite::Column next() { return statement_.getColumn(column_++); }

    SQLite::Statement& statement_;
    int column_ = 0;
};

// Statements for a table with the columns of `Row`; `where` is what follows.
template <class Row>
[[nodiscard]] ColumnNames names_of() {
    ColumnNames names;
    const Row row{};
    columns(names, row);
    return names;
}

template <class Row>
[[nodiscard]] std::string insert_into(const std::string& table) {
    const ColumnNames names = names_of<Row>();
    const std::string values = names.list(":");
    return "INSERT INTO " + table + " (" + names.list() + ", sum) VALUES (" + values + ", row_sum(" + values +
           "))";
}

template <class Row>
[[nodiscard]] std::string update(const std::string& table, const std::string& where) {
    const ColumnNames names = names_of<Row>();
    return "UPDATE " + table + " SET " + names.assignments() + ", sum = row_sum(" + names.list(":") + ") " +
           where;
}

// The row's columns, then whether it is sound, then `more`.
template <class Row>
[[nodiscard]] std::string select_from(const std::string& table,
                                      const std::string& where,
                                      const std::string& more = "") {
    const std::string list = names_of<Row>().list(table + ".");
    return "SELECT " + list + ", row_sum(" + list + ") IS " + table + ".sum" + more + " FROM " + table + " " +
           where;
}

}  // namespace drtv::farm
