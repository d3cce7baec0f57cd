// Runs WGSL on Dawn: run_wgsl.mjs JOBS.json, a list of {"source": file, "case": folder, "out": file}; a
// shader that does not compile is an error. Dawn and its types are npm's `webgpu`, found by WEBGPU_MODULE.
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const { create, globals } = await import(process.env.WEBGPU_MODULE);
Object.assign(globalThis, globals);
const gpu = create([]);
const adapter = await gpu.requestAdapter();
if (!adapter)
    throw new Error('no WebGPU adapter: is VK_DRIVER_FILES set to a Vulkan driver?');
const device = await adapter.requestDevice();

const bytesOf = { rgba8unorm: 4, rgba16float: 8, rg32float: 8, rgba32float: 16 };
const isFiltered = (texture) => !texture.format.includes('32');

// Buffers, textures, a sampler: used by the shader or not.
function layoutOf(textures) {
    const visibility = GPUShaderStage.COMPUTE;
    const entries = [{ buffer: { type: 'read-only-storage' } }, { buffer: { type: 'read-only-storage' } }, { buffer: { type: 'storage' } }];
    for (const texture of textures) {
        const sampleType = isFiltered(texture) ? 'float' : 'unfilterable-float';
        entries.push({ texture: { sampleType, viewDimension: `${texture.size.length}d` } });
    }
    entries.push({ sampler: { type: 'filtering' } });
    return device.createBindGroupLayout({ entries: entries.map((entry, binding) => ({ ...entry, binding, visibility })) });
}

function textureOf({ size, format }, data) {
    const [width, height, depthOrArrayLayers = 1] = size;
    const extent = { width, height, depthOrArrayLayers };
    const texture = device.createTexture({
        size: extent, dimension: `${size.length}d`, format, usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST,
    });
    device.queue.writeTexture({ texture }, data, { bytesPerRow: width * bytesOf[format], rowsPerImage: height }, extent);
    return texture;
}

async function run(job) {
    const file = (name) => readFileSync(join(job.case, name));
    const about = JSON.parse(file('case.json'));
    const module = device.createShaderModule({ code: readFileSync(job.source, 'utf8') });
    const messages = (await module.getCompilationInfo()).messages.filter((m) => m.type === 'error');
    if (messages.length > 0)
        throw new Error(`${job.source}:${messages[0].lineNum}: ${messages[0].message}`);
    const layout = layoutOf(about.textures);
    const pipeline = await device.createComputePipelineAsync({
        layout: device.createPipelineLayout({ bindGroupLayouts: [layout] }), compute: { module, entryPoint: 'main' },
    });
    const textures = about.textures.map((texture) => textureOf(texture, file(texture.file)));
    const addressMode = about.repeat ? 'repeat' : 'clamp-to-edge';
    const sampler = device.createSampler({
        magFilter: 'linear', minFilter: 'linear',
        addressModeU: addressMode, addressModeV: addressMode, addressModeW: addressMode,
    });
    const storage = (data) => {
        const buffer = device.createBuffer({ size: data.byteLength, usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST });
        device.queue.writeBuffer(buffer, 0, data);
        return buffer;
    };
    const points = file('points');
    const bytes = 2 * points.byteLength;
    const results = device.createBuffer({ size: bytes, usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_SRC });
    const resources = [{ buffer: storage(points) }, { buffer: storage(file('numbers')) }, { buffer: results },
        ...textures.map((t) => t.createView()), sampler];
    const entries = resources.map((resource, binding) => ({ binding, resource }));
    const group = device.createBindGroup({ layout, entries });
    const encoder = device.createCommandEncoder();
    const pass = encoder.beginComputePass();
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, group);
    pass.dispatchWorkgroups(Math.ceil(points.byteLength / 32 / 64));
    pass.end();
    const read = device.createBuffer({ size: bytes, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
    encoder.copyBufferToBuffer(results, 0, read, 0, bytes);
    device.queue.submit([encoder.finish()]);
    await read.mapAsync(GPUMapMode.READ);
    writeFileSync(job.out, Buffer.from(read.getMappedRange()));
}

for (const job of JSON.parse(readFileSync(process.argv[2])))
    await run(job);
process.exit(0);
