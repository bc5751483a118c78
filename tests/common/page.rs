//! A page of HTML: whether it is well formed, whether it needs anything from outside, and what stands in its tables.

/// Elements that have no end.
const VOID: [&str; 2] = ["meta", "br"];

/// Asserts that every element is closed in its order, that every attribute has quotes, and that nothing is fetched from outside.
pub fn assert_sound(page: &str) {
    assert!(page.starts_with("<!DOCTYPE html>"), "{}", &page[..40]);
    let mut open: Vec<&str> = Vec::new();
    let mut rest = &page["<!DOCTYPE html>".len()..];
    while let Some(start) = rest.find('<') {
        assert!(!rest[..start].contains('>') || open.last() == Some(&"style"), "a loose bracket in {:?}", open);
        rest = &rest[start + 1..];
        let end = rest.find('>').expect("every tag ends");
        let (tag, after) = (&rest[..end], &rest[end + 1..]);
        rest = after;
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name), "the end of <{name}>");
            continue;
        }
        let name = tag.split_whitespace().next().expect("a tag has a name");
        assert_eq!(tag.matches('"').count() % 2, 0, "<{tag}>");
        assert!(!["script", "link", "img", "iframe", "object", "base"].contains(&name), "<{tag}>");
        if !VOID.contains(&name) {
            open.push(name);
        }
    }
    assert_eq!(open, Vec::<&str>::new(), "what is still open at the end");
    for outside in ["http:", "https:", "src=", "url(", "@import"] {
        assert!(!page.contains(outside), "{outside} is in the page");
    }
    let links: Vec<&str> = page.split("href=\"").skip(1).map(|rest| rest.split('"').next().unwrap_or("")).collect();
    assert!(!links.is_empty());
    for link in links {
        let place = link.strip_prefix('#').unwrap_or_else(|| panic!("{link} leads out of the page"));
        assert!(page.contains(&format!("id=\"{place}\"")), "{link} leads nowhere");
    }
}

/// The text between the heading of a section and the next heading.
pub fn section<'a>(page: &'a str, title: &str) -> &'a str {
    let begin = page.find(&format!("<h3>{title}</h3>")).unwrap_or_else(|| panic!("there is no section {title}"));
    let rest = &page[begin + 4..];
    rest.split("<h3>").next().unwrap_or(rest)
}

/// A number as the page writes it.
pub fn number(value: f64, decimals: usize) -> String {
    format!("{value:.decimals$}").replace('-', "\u{2212}")
}
