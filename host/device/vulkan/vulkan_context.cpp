// SPDX-License-Identifier: MIT
#include "device/vulkan/vulkan_context.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "device/vulkan/vulkan_error.h"
#include "topple/error.h"

namespace topple::device {
namespace {

constexpr const char* vulkan_mend = "; install a driver, such as the package mesa-vulkan-drivers";
constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

bool validation_wanted() {
    const char* value = std::getenv("TOPPLE_VULKAN_VALIDATION");
    return value && std::strcmp(value, "1") == 0;
}

bool validation_installed() {
    const auto layers = vk_list<VkLayerProperties>(vkEnumerateInstanceLayerProperties);
    return std::ranges::any_of(layers, [](const VkLayerProperties& layer) {
        return std::strcmp(layer.layerName, validation_layer) == 0;
    });
}

VKAPI_ATTR VkBool32 VKAPI_CALL keep_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                            VkDebugUtilsMessageTypeFlagsEXT,
                                            const VkDebugUtilsMessengerCallbackDataEXT* data,
                                            void* user) {
    static_cast<ValidationLog*>(user)->messages.emplace_back(data->pMessage);
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(ValidationLog& log) {
    auto info = vk_struct<VkDebugUtilsMessengerCreateInfoEXT>(
        VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
    info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    info.pfnUserCallback = keep_message;
    info.pUserData = &log;
    return info;
}

// The entry point of an extension, which the loader does not export.
template <class Function>
Function entry(VkInstance instance, const char* name) {
    return reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
}

// Loaders unload drivers with their last instance, and some drivers can't be loaded again as often
// as devices are opened: NVIDIA's 25 times in a process. So one instance is never destroyed.
void keep_drivers_loaded() {
    static const VkInstance kept = [] {
        const auto info = vk_struct<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
        VkInstance made = VK_NULL_HANDLE;
        if (vkCreateInstance(&info, nullptr, &made) != VK_SUCCESS) made = VK_NULL_HANDLE;
        return made;
    }();
    static_cast<void>(kept);
}

void create_instance(VulkanContext& context) {
    keep_drivers_loaded();
    auto application = vk_struct<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
    application.pApplicationName = "topple";
    application.apiVersion = VK_API_VERSION_1_1;
    auto info = vk_struct<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
    info.pApplicationInfo = &application;

    const char* extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME,
                                VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
    const VkValidationFeatureEnableEXT enable[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    auto features = vk_struct<VkValidationFeaturesEXT>(VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT);
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = enable;
    VkDebugUtilsMessengerCreateInfoEXT messenger{};
    if (validation_wanted() && !validation_installed()) {
        throw Error(ErrorKind::device,
                    std::string("TOPPLE_VULKAN_VALIDATION: the layer ") + validation_layer +
                        " is not installed; it is in the package vulkan-validationlayers");
    }
    if (validation_wanted()) {
        context.log = std::make_unique<ValidationLog>();
        messenger = messenger_info(*context.log);
        features.pNext = &messenger;  // also covers the instance's own creation
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &validation_layer;
        info.enabledExtensionCount = 2;
        info.ppEnabledExtensionNames = extensions;
    }
    const VkResult result = vkCreateInstance(&info, nullptr, &context.instance);
    if (result != VK_SUCCESS) {
        context.instance = VK_NULL_HANDLE;
        throw Error(ErrorKind::device,
                    "Vulkan finds no driver (" + vk_result_name(result) + ")" + vulkan_mend);
    }
    context.owned = true;
    if (context.log) {
        const auto create = entry<PFN_vkCreateDebugUtilsMessengerEXT>(
            context.instance, "vkCreateDebugUtilsMessengerEXT");
        messenger.pNext = nullptr;
        if (create)
            vk_check(create(context.instance, &messenger, nullptr, &context.messenger),
                     "validation messenger");
    }
}

std::vector<VkPhysicalDevice> physical_devices(VkInstance instance) {
    std::vector<VkPhysicalDevice> devices =
        vk_list<VkPhysicalDevice>([&](std::uint32_t* count, VkPhysicalDevice* to) {
            vk_check(vkEnumeratePhysicalDevices(instance, count, to), "listing Vulkan devices");
        });
    if (devices.empty())
        throw Error(ErrorKind::device, std::string("Vulkan finds no device") + vulkan_mend);
    return devices;
}

VkPhysicalDeviceProperties properties_of(VkPhysicalDevice physical) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(physical, &properties);
    return properties;
}

std::vector<VkQueueFamilyProperties> families_of(VkPhysicalDevice physical) {
    return vk_list<VkQueueFamilyProperties>([&](std::uint32_t* count, VkQueueFamilyProperties* to) {
        vkGetPhysicalDeviceQueueFamilyProperties(physical, count, to);
    });
}

bool computes(const VkQueueFamilyProperties& family) {
    return family.queueCount > 0 && (family.queueFlags & VK_QUEUE_COMPUTE_BIT);
}

// The family that computes, one without graphics first; -1 where there is none.
std::int64_t compute_family(VkPhysicalDevice physical) {
    const auto families = families_of(physical);
    std::int64_t any = -1;
    for (std::size_t i = 0; i < families.size(); ++i) {
        if (!computes(families[i])) continue;
        if (!(families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT)) return static_cast<std::int64_t>(i);
        if (any < 0) any = static_cast<std::int64_t>(i);
    }
    return any;
}

int rank(VkPhysicalDevice physical) {
    if (!vulkan_problem(physical).empty()) return 9;
    switch (properties_of(physical).deviceType) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return 0;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return 1;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return 2;
        default:
            return 3;
    }
}

void create_device(VulkanContext& context) {
    const float priority = 1.0f;
    auto queue = vk_struct<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
    queue.queueFamilyIndex = context.queue_family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    auto info = vk_struct<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    context.float_controls = float_controls_of(context.physical);
    const char* extension = VK_KHR_SHADER_FLOAT_CONTROLS_EXTENSION_NAME;
    if (context.float_controls.any()) {
        info.enabledExtensionCount = 1;
        info.ppEnabledExtensionNames = &extension;
    }
    vk_check(vkCreateDevice(context.physical, &info, nullptr, &context.device),
             std::string("opening Vulkan device ") + properties_of(context.physical).deviceName);
    vkGetDeviceQueue(context.device, context.queue_family, 0, &context.queue);
}

}  // namespace

VulkanContext::~VulkanContext() {
    if (!owned) return;
    if (device) vkDestroyDevice(device, nullptr);
    if (messenger) {
        const auto destroy =
            entry<PFN_vkDestroyDebugUtilsMessengerEXT>(instance, "vkDestroyDebugUtilsMessengerEXT");
        if (destroy) destroy(instance, messenger, nullptr);
    }
    if (instance) vkDestroyInstance(instance, nullptr);
}

std::string vulkan_problem(VkPhysicalDevice physical) {
    if (properties_of(physical).apiVersion < VK_API_VERSION_1_1)
        return "it offers less than Vulkan 1.1";
    if (compute_family(physical) < 0) return "it has no queue that computes";
    return {};
}

std::uint32_t timestamp_bits(VkPhysicalDevice physical, std::uint32_t family) {
    return families_of(physical).at(family).timestampValidBits;
}

bool family_computes(VkPhysicalDevice physical, std::uint32_t family) {
    const auto families = families_of(physical);
    return family < families.size() && computes(families[family]);
}

DeviceInfo describe_vulkan(VkPhysicalDevice physical) {
    auto driver = vk_struct<VkPhysicalDeviceDriverProperties>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES);
    auto largest = vk_struct<VkPhysicalDeviceMaintenance3Properties>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES);
    auto two =
        vk_struct<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
    two.pNext = &largest;
    // The driver's properties are part of Vulkan 1.2.
    if (properties_of(physical).apiVersion >= VK_API_VERSION_1_2) largest.pNext = &driver;
    vkGetPhysicalDeviceProperties2(physical, &two);
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);

    const VkPhysicalDeviceProperties& properties = two.properties;
    DeviceInfo info;
    info.backend = Backend::vulkan;
    info.name = properties.deviceName;
    info.driver = driver.driverName[0] ? std::string(driver.driverName) + ", " + driver.driverInfo
                                       : "driver " + std::to_string(properties.driverVersion);
    info.gpu = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU ||
               properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU ||
               properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU;
    for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
        if (!(memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)) continue;
        info.limits.memory_bytes =
            std::max<std::uint64_t>(info.limits.memory_bytes, memory.memoryHeaps[i].size);
    }
    const std::uint64_t allocation =
        std::min<std::uint64_t>(largest.maxMemoryAllocationSize, info.limits.memory_bytes);
    info.limits.max_allocation_bytes =
        allocation > slice_alignment ? allocation - slice_alignment : 0;
    info.limits.max_binding_bytes = std::min<std::uint64_t>(properties.limits.maxStorageBufferRange,
                                                            info.limits.max_allocation_bytes);
    info.limits.max_group_size = std::min(properties.limits.maxComputeWorkGroupInvocations,
                                          properties.limits.maxComputeWorkGroupSize[0]);
    info.limits.shared_bytes = properties.limits.maxComputeSharedMemorySize;
    return info;
}

std::unique_ptr<VulkanContext> open_vulkan_context() {
    auto context = std::make_unique<VulkanContext>();
    create_instance(*context);
    const std::vector<VkPhysicalDevice> devices = physical_devices(context->instance);
    context->physical = *std::ranges::min_element(
        devices, {}, [](VkPhysicalDevice physical) { return rank(physical); });
    if (const std::string problem = vulkan_problem(context->physical); !problem.empty()) {
        throw Error(ErrorKind::device, std::string("Vulkan device ") +
                                           properties_of(context->physical).deviceName +
                                           " can't be used: " + problem + vulkan_mend);
    }
    context->queue_family = static_cast<std::uint32_t>(compute_family(context->physical));
    create_device(*context);
    return context;
}

std::vector<Listing> list_vulkan() {
    std::vector<Listing> listings;
    try {
        VulkanContext context;
        create_instance(context);
        for (VkPhysicalDevice physical : physical_devices(context.instance)) {
            listings.push_back(unusable(Backend::vulkan, vulkan_problem(physical)));
            listings.back().usable = listings.back().problem.empty();
            listings.back().info = describe_vulkan(physical);
        }
    } catch (const Error& error) {
        listings.push_back(unusable(Backend::vulkan, error.what()));
    }
    return listings;
}

}  // namespace topple::device
