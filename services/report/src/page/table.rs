use maud::{Markup, html};

/// A table. The first column is words, the others numbers.
pub struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
    words: usize,
}

impl Table {
    /// Without rows.
    pub fn new(columns: &[&str]) -> Self {
        Self { columns: columns.iter().map(|column| (*column).to_owned()).collect(), rows: Vec::new(), words: 1 }
    }

    /// With so many columns of words at the left.
    pub fn words(mut self, words: usize) -> Self {
        self.words = words;
        self
    }

    /// Adds a row.
    pub fn row(&mut self, cells: Vec<String>) {
        self.rows.push(cells);
    }

    /// Whether there is nothing in it.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The table as it stands on the page.
    pub fn draw(&self) -> Markup {
        let numeric = |column: usize| (column >= self.words).then_some("number");
        html! {
            div class="wide" { table {
                thead { tr { @for (i, column) in self.columns.iter().enumerate() { th class=[numeric(i)] { (column) } } } }
                tbody { @for row in &self.rows {
                    tr { @for (i, cell) in row.iter().enumerate() { td class=[numeric(i)] { (cell) } } }
                } }
            } }
        }
    }

    /// The same, to be unfolded: the numbers of a plot.
    pub fn folded(&self, summary: &str) -> Markup {
        html! { @if !self.is_empty() { details { summary { (summary) } (self.draw()) } } }
    }
}
