#include "settings/message/job_settings.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <google/protobuf/unknown_field_set.h>

#include <concepts>

namespace drtv::settings {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

const Message& message_of(const v1::Job& job, const Setting& setting) {
    return is_of_bake(setting) ? static_cast<const Message&>(job.settings()) : job;
}

Message& message_of(v1::Job& job, const Setting& setting) {
    return is_of_bake(setting) ? static_cast<Message&>(*job.mutable_settings()) : job;
}

// Never null: a test asks for each setting's field.
const FieldDescriptor* field_of(const Message& message, const Setting& setting) {
    return message.GetDescriptor()->FindFieldByName(std::string(setting.name));
}

void set(Message& message, const Setting& setting, double value) {
    const FieldDescriptor* field = field_of(message, setting);
    const google::protobuf::Reflection& fields = *message.GetReflection();
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_UINT32)
        fields.SetUInt32(&message, field, static_cast<std::uint32_t>(value));
    else if (field->cpp_type() == FieldDescriptor::CPPTYPE_BOOL)
        fields.SetBool(&message, field, value != 0);
    else
        fields.SetFloat(&message, field, static_cast<float>(value));
}

double get(const Message& message, const FieldDescriptor* field) {
    const google::protobuf::Reflection& fields = *message.GetReflection();
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_UINT32)
        return fields.GetUInt32(message, field);
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_BOOL)
        return fields.GetBool(message, field) ? 1 : 0;
    return static_cast<double>(fields.GetFloat(message, field));
}

bool has_unknown_fields(const Message& message) {
    return !message.GetReflection()->GetUnknownFields(message).empty();
}

}  // namespace

void set_field(v1::Job& job, const Setting& setting, double value) {
    set(message_of(job, setting), setting, value);
}

tl::expected<JobSettings, std::string> read_settings(const v1::Job& job) {
    auto settings = preset(job.settings().preset());
    if (!settings)
        return settings;
    if (has_unknown_fields(job.settings()))
        return tl::unexpected(
            std::string("the settings have fields of another version of bake: use the same for both"));
    for (const Setting& setting : table()) {
        const Message& message = message_of(job, setting);
        const FieldDescriptor* field = field_of(message, setting);
        if (!message.GetReflection()->HasField(message, field))
            continue;
        const double value = get(message, field);
        if (auto checked = check(setting, value); !checked)
            return tl::unexpected(checked.error());
        assign(*settings, setting, value);
    }
    return settings;
}

void write_settings(const JobSettings& settings, v1::Job& job) {
    for (const Setting& setting : table())
        set_field(job, setting, value_of(settings, setting));
}

}  // namespace drtv::settings
