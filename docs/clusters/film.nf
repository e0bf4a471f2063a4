// nextflow run film.nf --preset fan --shards 8
params.preset = 'fan'
params.shards = 8

process shard {
    errorStrategy { task.exitStatus in [75, 143] ? 'retry' : 'terminate' }
    maxRetries 3
    cpus 2
    memory '2 GB'
    input: val i
    output: path "out/*/*.shard"
    script: "doppel render ${params.preset} --shard ${i}/${params.shards} --progress none"
}

process film {
    stageInMode 'copy'   // Doppel follows no symbolic links below out/
    publishDir '.', mode: 'copy'
    input: path shards, stageAs: "out/${params.preset}/*"
    output: path "out/*/*.{mp4,csv,json}"
    script: "doppel render ${params.preset} --merge --progress none"
}

workflow { shard(Channel.of(1..params.shards)) | collect | film }
